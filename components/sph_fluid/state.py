"""All that a fluid remembers from one step to the next."""

from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.interfaces.component import Fields

Array = NDArray[np.float64]
Whole = NDArray[np.int64]


@dataclass(slots=True)
class State:
    """Rows are the fluid, then the boundary (walls and surface samples), each sorted by cell.

    Position and density, velocity and pressure stand side by side, as pairs need them; of these,
    images in planes of symmetry follow (`boundary/symmetry.py`).
    """

    position_density: Array  # (n + images, 4) m, m, m, kg/m3: x, y, z, ρ
    velocity_pressure: Array  # (n + images, 4) m/s, m/s, m/s, Pa m6/kg2: u, v, w, p/ρ²
    previous_density_rate: Array  # (n,) kg/(m3 s), dρ/dt one step ago
    acceleration: Array  # (fluid, 3) m/s2, at the last step's end; (0, 3) if not symplectic
    minus_rho_div_u: Array  # (n,) kg/(m3 s), of the last pass over pairs; (0,) without a damper
    reference: Array  # (n, 3) m, where the neighbour list was made, with mirror points
    # (n + boundary, 3); (0, 3): there is none yet
    mirror_point: Array  # (boundary, 3) m, of walls and samples; (0, 3) without mdbc
    identity: Whole  # (fluid,) the number each fluid particle was born with
    exit_face: Whole  # (fluid,) number of the face through which it left the tank, from 1; 0 inside
    # of it; (0,) without a tank
    role: Whole  # (fluid,) number of the buffer that holds it, from 1: inflows, then outflows; 0
    # for fluid; (0,) without any
    sample: Whole  # (boundary,) row in the port `surface`; -1 for walls
    force: Array  # (samples, 3) N, mean over the last step
    film: Array  # (samples, 3) of films in narrow gaps: pressure [Pa], full share, width [m] or 0
    # where there is none; (0, 3) where they are not wanted
    judged: Array  # (10,) what `judgement` remembers
    lost_through: Whole  # (6,) particles that left the domain, by face of the tank
    first_lost: Array  # (5,) of the first of these: identity, number of the face from 0, and
    # x, y, z [m]; (0,) if there is none
    passed: (
        Whole  # (buffers,) particles that entered the fluid by each inflow, or left it by outflows
    )
    crossings: Whole  # (3,) periods that particles were brought back along each axis, in all
    largest_acceleration: float = 0.0  # m/s2, of the last step
    largest_approach: float = 0.0  # 1/s, largest |u·r|/(r²+0.01h²) of the last step
    moved: float = 0.0  # m, furthest that a fluid particle is from its reference
    last_dt: float = 0.0  # s
    steps: int = 0
    born: int = 0  # fluid particles that there ever were, with those of buffers
    at_start: int = 0  # fluid particles
    carried: float = 0.0  # J/kg, energy of particles that entered, less that of those that left
    returned: int = 0  # particles that left the fluid into an inflow
    removed: int = 0  # particles inside bodies at the start

    @classmethod
    def empty(cls, fluid: int, boundary: int) -> "State":
        """State of particles at rest that are nowhere yet."""
        n = fluid + boundary
        return cls(
            position_density=np.zeros((n, 4)),
            velocity_pressure=np.zeros((n, 4)),
            previous_density_rate=np.zeros(n),
            acceleration=np.zeros((0, 3)),
            minus_rho_div_u=np.zeros(0),
            reference=np.zeros((0, 3)),
            mirror_point=np.zeros((0, 3)),
            identity=np.arange(fluid),
            exit_face=np.zeros(0, np.int64),
            role=np.zeros(0, np.int64),
            sample=np.full(boundary, -1),
            force=np.zeros((0, 3)),
            film=np.zeros((0, 3)),
            judged=np.zeros(10),
            lost_through=np.zeros(6, np.int64),
            first_lost=np.zeros(0),
            passed=np.zeros(0, np.int64),
            crossings=np.zeros(3, np.int64),
            born=fluid,
            at_start=fluid,
        )

    @property
    def fluid(self) -> int:
        """Number of fluid particles."""
        return len(self.identity)

    @property
    def particles(self) -> int:
        """Number of fluid and boundary particles, without images."""
        return len(self.previous_density_rate)

    @property
    def lost(self) -> int:
        """Number of particles that left the domain."""
        return int(self.lost_through.sum())

    def fit_damper(self, is_damped: bool) -> None:
        """Have an array for the acoustic damper where there is one; a state may come without."""
        if is_damped != bool(len(self.minus_rho_div_u)):
            self.minus_rho_div_u = np.zeros(self.particles if is_damped else 0)

    def keep(self, fluid: Whole, boundary: Whole) -> None:
        """Keep these rows of the fluid and of the boundary, in this order; all else goes."""
        rows = np.concatenate([fluid, self.fluid + boundary])
        # `take` copies rows many times faster than indexing does.
        self.position_density = self.position_density.take(rows, axis=0)
        self.velocity_pressure = self.velocity_pressure.take(rows, axis=0)
        self.previous_density_rate = self.previous_density_rate[rows]
        if len(self.acceleration):
            self.acceleration = self.acceleration.take(fluid, axis=0)
        if len(self.minus_rho_div_u):
            self.minus_rho_div_u = self.minus_rho_div_u[rows]
        self.identity, self.sample = self.identity[fluid], self.sample[boundary]
        if len(self.exit_face):
            self.exit_face = self.exit_face[fluid]
        if len(self.role):
            self.role = self.role[fluid]
        if len(self.mirror_point):
            self.mirror_point = self.mirror_point.take(boundary, axis=0)

    def add_samples(self, count: int, density: float) -> None:
        """Append surface samples to the boundary; they are nowhere until they are placed."""
        rows = np.zeros((count, 4))
        self.velocity_pressure = np.concatenate([self.velocity_pressure, rows])
        rows[:, 3] = density
        self.position_density = np.concatenate([self.position_density, rows])
        none = np.zeros(count)
        self.previous_density_rate = np.concatenate([self.previous_density_rate, none])
        if len(self.minus_rho_div_u):
            self.minus_rho_div_u = np.concatenate([self.minus_rho_div_u, none])
        self.sample = np.concatenate([self.sample, np.arange(count)])
        self.force = np.zeros((count, 3))

    def sample_rows(self) -> Whole:
        """Rows of the samples, in the order of their port; (samples,)."""
        samples = np.flatnonzero(self.sample >= 0)
        return self.fluid + samples[np.argsort(self.sample[samples])]

    def save(self) -> dict[str, NDArray[Any]]:
        """Copy out everything but what stands behind the particles: images, and copies."""
        saved = {part.name: np.array(getattr(self, part.name)) for part in fields(self)}
        for name in ("position_density", "velocity_pressure"):
            saved[name] = saved[name][: self.particles]
        return saved

    @classmethod
    def load(cls, saved: Fields) -> "State":
        """Make the state that was saved."""
        arrays = {part.name: np.array(saved[part.name]) for part in fields(cls)}
        parts: dict[str, Any] = {name: a if a.ndim else a.item() for name, a in arrays.items()}
        return cls(**parts)
