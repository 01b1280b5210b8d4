"""What a scene's partners must be like: checked with the scene, and as ports are joined."""

from quintet.components.mooring_lines.params import MooringLinesParams
from quintet.interfaces.component import Fields, Keys
from quintet.interfaces.errors import SceneError


def refuse_joins(params: MooringLinesParams, static: Fields, joined: Keys) -> None:
    """Refuse what links bring, as a scene is checked and as ports are joined."""
    _refuse_half_links(joined)
    if "motion.mass" in static:
        _refuse_missing_bodies(params, len(static["motion.mass"]))


def _refuse_missing_bodies(params: MooringLinesParams, bodies: int) -> None:
    """Refuse lines of bodies that no partner has."""
    wrong = [(k, line.body) for k, line in enumerate(params.lines) if line.body >= bodies]
    if wrong:
        raise SceneError(
            [
                f"lines.{k}.body must be below {bodies}, the number of bodies that links bring; "
                f"found {body}. Correct it."
                for k, body in wrong
            ]
        )


def _refuse_half_links(joined: Keys) -> None:
    """Refuse links that bring the motion of bodies and take no load, or the other way round."""
    ports = {"motion", "load"}
    if joined and not ports <= joined:
        (lacking,) = ports - joined
        raise SceneError(
            f"links must join both motion and load of mooring lines; {lacking} has no partner. Add "
            "a pair for it to the link."
        )
