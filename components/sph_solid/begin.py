"""What a start must have: of bodies, and of the state of another run."""

import numpy as np

from quintet.components.sph_solid.ranks.method import Ranks
from quintet.components.sph_solid.state import Array, State
from quintet.interfaces.component import Fields
from quintet.interfaces.errors import SceneError

SAME = 1e-9  # relative difference of volumes that are the same
CLOSE = 1e-6  # spacings
OF_EACH = ("body", "material", "glue", "fixed")  # what parameters say of each particle
JUDGED = ("ranges", "sums", "viscous", "torn")
CLOCK = {"time": 0.0, "steps": 0, "work": 0.0}


def restarted(saved: Fields, start: State, ranks: Ranks, spacing: float, keeps: bool) -> Fields:
    """Return a saved state with the clock at 0 and nothing judged.

    Parameters
    ----------
    saved : mapping of arrays
    start : State
        As constructed, on several ranks the particles of this one.
    ranks : Ranks
    spacing : float, m
    keeps : bool
        Whether neighbours are those of the start, so that the places of the start count.

    Raises
    ------
    SceneError
        Where the state is of other particles.
    """
    refuse_other_particles(saved, start, ranks, spacing, keeps)
    judged = {name: np.zeros_like(getattr(start, name)) for name in JUDGED}
    return {**saved, **judged, **{name: np.array(number) for name, number in CLOCK.items()}}


def refuse_other_particles(
    saved: Fields, start: State, ranks: Ranks, spacing: float, keeps: bool
) -> None:
    """Refuse a state of another number of particles, or of particles that differ."""
    count, saved_count = ranks.particles(start), len(saved["identity"])
    if saved_count != count or not np.array_equal(np.sort(saved["identity"]), np.arange(count)):
        raise SceneError(
            "bodies must have as many particles as in the state that it begins from, "
            f"{saved_count}; found {count}. Make spacing and bodies as they were in that run, or "
            "leave it out of begin_from.components."
        )
    row = np.argsort(saved["identity"])[start.identity]
    differ = {name: saved[name][row] != getattr(start, name) for name in OF_EACH}
    differ["volume"] = np.abs(saved["volume"][row] - start.volume) > SAME * start.volume
    if keeps:
        apart = np.abs(saved["reference"][row] - start.reference).max(axis=1, initial=0.0)
        differ["place at the start"] = apart > CLOSE * spacing
    counts = ranks.greatest(np.array([float(mask.sum()) for mask in differ.values()]))
    names = [name for name, wrong in zip(differ, counts, strict=True) if wrong]
    if names:
        raise SceneError(
            "particles must have the body, material, support, glue and volume that they have in "
            "the state that it begins from (with total_lagrangian also the place at the start); "
            f"found another {' and '.join(names)} of up to {counts.max():.0f} particles. Make "
            "spacing and bodies as they were in that run, or leave it out of "
            "begin_from.components."
        )


def refuse_thin_bodies(state: State, gradient: Array, ranks: Ranks) -> None:
    """Refuse neighbours of the start that span no space: they give no gradient (n, 9) 1/s."""
    without = state.body[~np.isfinite(gradient).all(axis=1)]
    body = int(ranks.greatest(np.array([float(without.max(initial=-1))]))[0])
    if body >= 0:
        raise SceneError(
            f"bodies.{body}: with the neighbours of the start (total_lagrangian) each particle "
            "needs neighbours in all directions; found a body of one layer of particles, or one "
            "particle. Take a smaller spacing, or set total_lagrangian to false."
        )
