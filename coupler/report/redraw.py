"""A run drawn again, from what it left: other times, fields, colours, places, views."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from quintet.coupler.files import vtkhdf_reader
from quintet.coupler.files.run_files import DRAWN, DRAWN_3D, RESULTS, SCENE
from quintet.coupler.measures.expectation import ROUNDING
from quintet.coupler.report.free_place import free_place
from quintet.coupler.report.picture import Picture, draw_run
from quintet.coupler.report.show import results
from quintet.coupler.report.view_steps import DISPLACEMENT, view_files
from quintet.coupler.report.viewpoint import SIDE, VIEWPOINTS, Box
from quintet.coupler.scene.read import parse
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import unknown

FORMATS = (".png", ".svg", ".pdf", ".jpg")


@dataclass(frozen=True)
class Wanted:
    """What differs from the pictures that the scene asks for; nothing where it is empty or None.

    Attributes
    ----------
    times : sequence of float, s
    colours : sequence of str
        ``component.field``
    ranges : mapping of str to two numbers
        Ends of the colours of a component, by its name.
    view : str
        One of side, front and top; "": side, or obliquely from above in three dimensions.
    section : float, m
    region : two corners, m
    displacement_scale : float
    """

    times: Sequence[float] = ()
    colours: Sequence[str] = ()
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    view: str = ""
    section: float | None = None
    region: Box | None = None
    displacement_scale: float | None = None


def redraw(folder: Path, wanted: Wanted, out: Path | None = None, force: bool = False) -> Path:
    """Draw a run again, also one that failed or still runs; return the picture.

    Parameters
    ----------
    folder : Path
        Of a run.
    wanted : Wanted
    out : Path, optional
        The picture; ``drawn.png`` in the folder if not given, which may be there.
    force : bool
        Replace another file.
    """
    chosen = _picture(_files(folder), _output_of(folder), wanted)
    place = free_place(folder / DRAWN, out, FORMATS, force)
    return draw_run(folder, place, chosen, title_of(folder))


def _files(folder: Path) -> list[Path]:
    """View files of a run."""
    if files := view_files(folder) if folder.is_dir() else []:
        return files
    raise SceneError(
        f"run {folder}: it has no view with steps to draw. Name the folder of a run whose "
        "scene has output.interval or output.pictures."
    )


def redraw_3d(folder: Path, wanted: Wanted, out: Path | None = None, force: bool = False) -> Path:
    """Draw a run in three dimensions, as `redraw` does; of a film `out` is given.

    Without times a film has all steps of the run.
    """
    # Start-up: only these pictures need it.
    from quintet.coupler.report.views3d import MOVIES, STILLS, animate, draw_3d

    if wanted.section is not None or wanted.region is not None:
        raise SceneError(
            "a view in three dimensions shows the whole run; --section and --region are for "
            "pictures in two. Remove them."
        )
    chosen = _picture(_files(folder), _output_of(folder), wanted)
    title = title_of(folder)
    if out is not None and out.suffix.lower() in MOVIES:
        place = free_place(folder / DRAWN_3D, out, MOVIES, force)
        return animate(folder, place, chosen, wanted.view, title, every=not wanted.times)
    place = free_place(folder / DRAWN_3D, out, STILLS, force)
    return draw_3d(folder, place, chosen, wanted.view, title)


def _output_of(folder: Path) -> Mapping[str, Any]:
    """What the scene of a run says of its output; nothing where the run left no scene."""
    return parse(folder / SCENE).get("output", {}) if (folder / SCENE).is_file() else {}


def title_of(folder: Path) -> str:
    """Name of what ran, as far as the run has told."""
    if not (folder / RESULTS).is_file():
        return folder.name
    run = results(folder)
    preset = f" ({run['preset']})" if run.get("preset") else ""
    return f"{run.get('scene', folder.name)}{preset}"


def _picture(files: Sequence[Path], output: Mapping[str, Any], wanted: Wanted) -> Picture:
    """Choose the picture: what is wanted, else what the scene asks for."""
    times = [vtkhdf_reader.times(path) for path in files]
    last = max(float(steps[-1]) for steps in times)
    due = [time for time in output.get("pictures", ()) if time <= last * (1.0 + ROUNDING)]
    shows = {path.name.partition(".")[0]: tuple(vtkhdf_reader.units(path)) for path in files}
    mistakes = [*_unknown_fields(shows, wanted.colours), *_unknown_names(shows, wanted.ranges)]
    if wanted.displacement_scale and not any(DISPLACEMENT in fields for fields in shows.values()):
        mistakes.append(
            "--displacement-scale is for components that show displacements; none of "
            f"{', '.join(shows)} does. Remove it."
        )
    if mistakes:
        raise SceneError(*mistakes)
    asked = {colour.partition(".")[0] for colour in wanted.colours}
    kept_from_scene = [c for c in output.get("colours", ()) if c.partition(".")[0] not in asked]
    scale = wanted.displacement_scale or float(output.get("displacement_scale", 1.0))
    viewpoint = VIEWPOINTS[wanted.view or "side"]
    from_scene = output.get("region") if viewpoint is SIDE and wanted.section is None else None
    return Picture(
        times=wanted.times or due or [last],
        colours=[*kept_from_scene, *wanted.colours],
        ranges=wanted.ranges,
        region=wanted.region or from_scene,
        section=wanted.section,
        displacement_scale=scale,
        viewpoint=viewpoint,
    )


def _unknown_fields(shows: Mapping[str, Sequence[str]], colours: Iterable[str]) -> list[str]:
    """Say which colours are no fields of what components show."""
    mistakes = []
    for colour in colours:
        name, _, shown = colour.partition(".")
        if name not in shows:
            mistakes.append(unknown(f"--colour {colour}: component {name}", name, shows))
        elif shown not in shows[name]:
            mistakes.append(unknown(f"--colour {colour}: field {shown}", shown, shows[name]))
    return mistakes


def _unknown_names(shows: Mapping[str, Sequence[str]], ranges: Iterable[str]) -> list[str]:
    return [
        unknown(f"--range {name}=...: component {name}", name, shows)
        for name in ranges
        if name not in shows
    ]
