"""What indicates that a lattice breaks up, and what is said of it."""

import numpy as np

from quintet.components.particle_dynamics.build import CLOSE, place_at_start
from quintet.components.particle_dynamics.params import Drive, Lattice
from quintet.components.particle_dynamics.state import State, Whole
from quintet.components.shared.finite_items import require_finite_items
from quintet.interfaces.errors import StepError

CHECKED = 20  # steps between two checks for lost points
INTACT = 0.95  # share of the bonds below which the lattice is broken
MISSING = 0.01  # of the energy put in, above which the audit warns


class Losses:
    """Points that left all others, broken bonds and missing energy, each with its first time."""

    def __init__(self) -> None:
        self.unchecked = 0  # steps since the last check
        # Times [s] of a lost point, of broken bonds, of missing energy; the point. -1: none.
        self.times = np.full(4, -1.0)

    def check(self, time: float, near: int, point: int, intact: float) -> None:
        """Note the times [s] of the first lost point and of broken bonds.

        Parameters
        ----------
        time : float, s
        near, point : int
            Fewest points that a point has within the cut-off, and that point.
        intact : float
            Share of the bonds that are neither short nor long.
        """
        self.unchecked = 0
        if self.times[0] < 0.0 and near == 0:
            self.times[0], self.times[3] = time, point
        if self.times[1] < 0.0 and intact < INTACT:
            self.times[1] = time

    def check_energy(self, missing: float, time: float) -> None:
        """Note the first time [s] of a share of energy that is missing."""
        if self.times[2] < 0.0 and abs(missing) > MISSING:
            self.times[2] = time

    @property
    def broken(self) -> bool:
        """Whether a point was lost or bonds were broken."""
        return bool((self.times[:2] >= 0.0).any())

    def warnings(self, lattice: Lattice) -> dict[str, str]:
        """Warn of each; points are named by their positions at the start."""
        lost, broken, missing, point = self.times.tolist()
        sentences = {}
        if lost >= 0.0:
            sentences["lost point"] = (
                f"{_named(int(point), lattice)}, has left all others behind, at {lost:g} s: drive "
                "or heat less, or damp more."
            )
        if broken >= 0.0:
            sentences["broken bonds"] = (
                f"less than {INTACT:.0%} of the bonds between nearest points are intact, at "
                f"{broken:g} s: the lattice has broken up. Drive or heat less, or damp more."
            )
        if missing >= 0.0:
            sentences["energy"] = (
                f"the energy audit lacks more than {MISSING:.0%} of what was put in, at "
                f"{missing:g} s: take a smaller courant."
            )
        return sentences


def drive_notes(drive: Drive | None, lattice: Lattice) -> tuple[str, ...]:
    """Note a drive that is strong enough to break most lattices up."""
    if drive is None or drive.amplitude < 0.1 * lattice.spacing * CLOSE:
        return ()
    return (
        f"drive: an amplitude of {drive.amplitude / lattice.spacing:.2g} spacings breaks most "
        "lattices up; 0.05 to 0.08 do not.",
    )


def _named(point: int, lattice: Lattice) -> str:
    return f"point {point}, at {place_at_start(lattice, point)} m at the start"


def failure(point: int, lattice: Lattice, time: float, skin: float, dt: float) -> StepError:
    """Name the point that moved furthest in a step dt [s] that neighbour lists do not allow."""
    return StepError(
        f"{_named(point, lattice)}: it must move by less than {0.2 * skin:.3g} m in a step of "
        f"{dt:.3g} s, and did not, at {time:g} s. Take a smaller courant, or drive and heat less.",
        place_at_start(lattice, point),
    )


def check(state: State, numbers: Whole, rows: Whole | slice) -> None:
    """Refuse points whose motion or energies are not finite.

    Parameters
    ----------
    state : State
        Of this rank.
    numbers : (m,) int array
        Of its points.
    rows : (m,) int array or slice
        Of these in the state.
    """
    fields = {"velocity": state.velocity[rows], "kinetic energy": state.kinetic[rows]}
    advice = "Take a smaller courant, or drive and heat less."
    require_finite_items("point", fields, numbers, state.position[rows], advice)
