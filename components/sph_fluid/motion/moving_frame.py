"""The frame of a tank that moves; imported only by a scene that asks.

Walls, obstacles and meshes stand still in it, and so do gauges. With the tank displaced by s(t) and
turned by R(t), at the angular velocity ω about a fixed axis n through a point P of the tank, what
is at x in the tank is at P + s + R(x - P) in the world, and

    du/dt = F/m + Rᵀ(g - s̈) - ω̇ × (x - P) - ω × (ω × (x - P)) - 2ω × u

(Landau & Lifshitz, Mechanics (1976), article 39). Pairs are given the gravity of the scene; what is
beside it is added here: c + G x - 2ω × u, and its power counts as work done by the motion, so that
kinetic energy in the tank's frame, m g·x of the scene's gravity and elastic energy change by that
work and by what is dissipated. Forces are those of the middle of each step, and of places and
velocities there, so that the motion is of second order in the step.
"""

import math

import numpy as np

from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.constants import constants
from quintet.components.sph_fluid.laws import PairLaw
from quintet.components.sph_fluid.motion.kernels import add_frame_acceleration
from quintet.components.sph_fluid.motion.laws import FrameForces
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.ranks.method import Ranks
from quintet.components.sph_fluid.setup.motion import Motion
from quintet.components.sph_fluid.setup.trajectory import ROUNDING
from quintet.components.sph_fluid.state import Array, State
from quintet.interfaces.component import Fields
from quintet.interfaces.errors import SceneError, StepError

SAVED = "motion"  # key of a saved state: time [s] and work [J]


class MovingFrame:
    """The frame of one fluid's tank."""

    def __init__(self, params: SphFluidParams, motion: Motion, ranks: Ranks) -> None:
        self.params, self.ranks, self.trajectory = params, ranks, motion.trajectory
        self.point, self.axis = np.array(motion.point), motion.direction
        self.cross = crossing(self.axis)  # (3, 3) 1
        self.cross_squared = product(self.cross, self.cross)
        self.gravity = np.array(params.gravity)
        boxes = [params.boundary.tank] if params.boundary.tank else params.extents
        lows, highs = zip(*boxes, strict=True)
        self.middle = 0.5 * (np.min(lows, axis=0) + np.max(highs, axis=0))  # (3,) m
        self.mass = constants(params).mass * params.slab_thickness  # kg, of a particle
        # Rates are then computed of places and velocities at the begin of a step.
        self.rates_precede_middle = params.integration == "extrapolated"
        self.time, self.work, self.later = 0.0, 0.0, 0.0
        self.power = np.zeros(0)  # (fluid,) m2/s3
        self.set_time(0.0)

    def weight_at(self, points: Array) -> Array:
        """Acceleration (n, 3) m/s2 that fluid at rest at points (n, 3) m is held against."""
        x, y, z = points.T
        at_rest = (self.gravity + self.uniform).tolist()
        rows = zip(at_rest, self.gradient.tolist(), strict=True)
        return np.stack([a + g[0] * x + g[1] * y + g[2] * z for a, g in rows], axis=1)

    def set_time(self, later: float) -> None:
        """Set the forces to those at a time [s] after the begin of the step."""
        time, end = self.time + later, self.trajectory.end
        if time > end + ROUNDING * abs(end):
            raise StepError(
                f"boundary.motion must go on until the run's end; its table ends at {end:g} s, and "
                f"a step goes on to {time:g} s. Extend the table, or end the run before."
            )
        self.later = later
        place, rate, second = self.trajectory.at(time)
        turned = turn_back(self.gravity - second[:3], self.axis, self.cross, float(place[3]))
        omega, alpha = float(rate[3]), float(second[3])
        self.gradient = -alpha * self.cross - omega * omega * self.cross_squared  # (3, 3) 1/s2
        self.uniform = turned - self.gravity - times(self.gradient, self.point)  # (3,) m/s2
        self.turning = 2.0 * omega * self.axis  # (3,) 1/s
        x, y, z = self.weight_at(self.middle[np.newaxis])[0].tolist()
        self.rest_acceleration = x, y, z  # m/s2, of the middle of the tank

    @property
    def forces(self) -> FrameForces:
        """What its accelerations are made of at that time."""
        lead = self.later if self.rates_precede_middle else 0.0
        uniform, turning = tuple(self.uniform.tolist()), tuple(self.turning.tolist())
        x, y, z = (tuple(row) for row in self.gradient.tolist())
        return FrameForces(lead, uniform, (x, y, z), turning)

    def law(self, law: PairLaw) -> PairLaw:
        """The pair law, with the density at rest rising as it does in the middle of the tank."""
        diffusion = law.fluid.diffusion
        if diffusion.on is None:
            return law
        number, per = type(diffusion.x), self.params.density / self.params.sound_speed**2
        x, y, z = (number(per * a) for a in self.rest_acceleration)
        fluid = law.fluid._replace(diffusion=diffusion._replace(x=x, y=y, z=z))
        return law._replace(fluid=fluid)

    def accelerate(self, state: State, rate: Array, largest: float, team: Team) -> float:
        """Add the frame's own accelerations to the rates (n, 4); return the largest [m/s2]."""
        if len(self.power) != state.fluid:
            self.power = np.zeros(state.fluid)
        arrays = (state.position_density, state.velocity_pressure, rate, self.power)
        squares = team.run(add_frame_acceleration, state.fluid, self.forces, *arrays)
        return math.sqrt(max(squares))

    def count_work(self, state: State, dt: float) -> None:
        """Count the work of a step [s], by the forces in its middle."""
        (power,) = self.ranks.sums(state, [self.power]).tolist()
        self.work += dt * self.mass * power

    def advance(self, dt: float) -> None:
        """Go on to the end of a step [s]."""
        self.time += dt
        self.set_time(0.0)

    def save(self) -> dict[str, Array]:
        """Copy out its clock, and its work."""
        return {SAVED: np.array([self.time, self.work])}

    def load(self, state: Fields) -> None:
        """Come back to a saved state; one of a tank that stood still is that of the start."""
        self.time, self.work = state.get(SAVED, np.zeros(2)).tolist()
        self.set_time(0.0)

    def refuse_bodies(self) -> None:
        """Refuse surfaces of partners: these move in the frame of the world."""
        raise SceneError(
            "boundary.motion moves the frame of the fluid with its tank, and a link brings bodies "
            "that move in the frame of the world. Remove the link, or boundary.motion."
        )


def crossing(axis: Array) -> Array:
    """Matrix (3, 3) whose product with a vector is axis × vector."""
    x, y, z = axis.tolist()
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def times(matrix: Array, vector: Array) -> Array:
    """Product (3,) of a matrix and a vector; written out, as libraries may sum in any order."""
    (x, y, z), rows = vector.tolist(), matrix.tolist()
    return np.array([row[0] * x + row[1] * y + row[2] * z for row in rows])


def product(first: Array, other: Array) -> Array:
    """Product (3, 3) of two matrices."""
    return np.stack([times(first, column) for column in other.T], axis=1)


def turn_back(vector: Array, axis: Array, cross: Array, angle: float) -> Array:
    """A vector (3,) of the world along axes that are turned by an angle [rad]; Rodrigues.

    `cross` (3, 3) is that of `crossing` of the axis.
    """
    c, s = math.cos(angle), math.sin(angle)
    along = float(axis[0] * vector[0] + axis[1] * vector[1] + axis[2] * vector[2])
    return np.asarray(c * vector - s * times(cross, vector) + (1.0 - c) * along * axis)
