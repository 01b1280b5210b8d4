"""All arrays of bodies of particles: what is remembered, and what pairs are computed from."""

from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.interfaces.component import Fields

Array = NDArray[np.float64]
Whole = NDArray[np.int64]


@dataclass(slots=True)
class State:
    """What is remembered from one step to the next; n particles, sorted by cell."""

    position: Array  # (n, 3) m
    velocity: Array  # (n, 3) m/s
    acceleration: Array  # (n, 3) m/s2
    heating: Array  # (n,) W/kg, of the artificial viscosity
    deviator: Array  # (n, 6) Pa, xx yy zz xy yz zx
    density_ratio: Array  # (n,) 1, η = ρ/ρ₀
    pressure: Array  # (n,) Pa
    energy: Array  # (n,) J/kg
    strain: Array  # (n,) 1, plastic
    temperature: Array  # (n,) K
    damage: Array  # (n,) 1
    failed: Array  # (n,) 1 or 0
    sound: Array  # (n,) m/s, of longitudinal waves
    volume: Array  # (n,) m3, at the start
    material: Whole  # (n,)
    body: Whole  # (n,)
    glue: Whole  # (n,) row in the port `glued`; -1 of all others
    fixed: Whole  # (n,) 1 2 4 added up: along x, y, z; 0 of what is free
    identity: Whole  # (n,) the number each was born with
    reference: Array  # (n, 3) m, where the neighbour list was made
    pulled: Array  # (glued, 3) m/s, of glued particles
    active: Array  # (glued,) 1, 0 once it is free
    force: Array  # (glued, 3) N, on glued particles now
    ranges: Array  # (3, 2) J, least and greatest kinetic, potential and internal energy so far
    sums: Array  # (3,) J, sum of energies less work from outside: first, least, greatest
    viscous: Array  # (3,) J, heat of viscosity in elastic bodies: now, least, and before the run
    torn: Array  # (5,) 1, s, m, m, m: most bonds lost at a time; when and where the first was lost
    reach: float = 0.0  # m, of the neighbour list
    bound: float = 0.0  # s, stable step of all particles
    time: float = 0.0  # s
    steps: int = 0
    work: float = 0.0  # J, done on glued particles by what they hang on

    @property
    def particles(self) -> int:
        """Number of particles."""
        return len(self.position)

    def reorder(self, rows: Whole) -> None:
        """Bring particles into another order."""
        for name in OF_PARTICLES:
            setattr(self, name, getattr(self, name).take(rows, axis=0))

    def save(self) -> dict[str, NDArray[Any]]:
        """Copy out everything."""
        return {part.name: np.array(getattr(self, part.name)) for part in fields(self)}

    @classmethod
    def load(cls, saved: Fields) -> "State":
        """Make the state that was saved."""
        arrays = {part.name: np.array(saved[part.name]) for part in fields(cls)}
        values: dict[str, Any] = {name: a if a.ndim else a.item() for name, a in arrays.items()}
        return cls(**values)


OF_ALL = (
    "pulled", "active", "force", "ranges", "sums", "viscous", "torn", "reach", "bound", "time",
    "steps", "work",
)  # fmt: skip
OF_PARTICLES = tuple(part.name for part in fields(State) if part.name not in OF_ALL)


def chosen(state: State, rows: Whole) -> State:
    """Some particles of a state, in this order."""
    arrays: dict[str, Any] = {name: getattr(state, name)[rows] for name in OF_PARTICLES}
    return replace(state, **arrays)


@dataclass(slots=True)
class Rows:
    """What pairs are computed from, of particles and then of their images."""

    place: Array  # (n + images, 4) m, m, m, m3: x, y, z and volume at the start
    motion: Array  # (n + images, 4) m/s: u, v, w, and whether it has failed, or speed of sound
    stress: Array  # (n + images, 8, 12 or 16) Pa, kg/m3: σ/η² and ρ, ρ₀; see `kernels`
    gradient: Array  # (n, 9) 1/s, of velocity
    correction: Array  # (n, 6) 1; (0, 6) without

    @classmethod
    def empty(cls, particles: int, images: int, corrected: bool, width: int) -> "Rows":
        """Make room, with rows of stress of a width."""
        count = particles + images
        return cls(
            place=np.zeros((count, 4)),
            motion=np.zeros((count, 4)),
            stress=np.zeros((count, width)),
            gradient=np.zeros((particles, 9)),
            correction=np.zeros((particles if corrected else 0, 6)),
        )

    def fill(self, state: State, place: Array, last: Array) -> None:
        """Copy places (n, 3) m, volumes and velocities; `last` (n,) ends the rows of motion."""
        count = state.particles
        self.place[:count, :3], self.place[:count, 3] = place, state.volume
        self.motion[:count, :3], self.motion[:count, 3] = state.velocity, last
