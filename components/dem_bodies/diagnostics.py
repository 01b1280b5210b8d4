"""Why a run must end, warnings, points of contact, and totals."""

import math
from dataclasses import dataclass

import numpy as np

from quintet.components.dem_bodies.contact import ball_search
from quintet.components.dem_bodies.contact.materials import DURATION, SPEED_UP
from quintet.components.dem_bodies.kernels.locked_motion import write_momenta_of_locked
from quintet.components.dem_bodies.state import (
    CONTACT_WORK,
    DEEPEST,
    DEEPEST_PAIR,
    ELASTIC_ENERGY,
    LOAD_WORK,
    STIFFEST,
    TOUCHING,
    BallPairs,
    BodyPairs,
    Model,
    Numbers,
    State,
)
from quintet.components.shared.finite_items import require_finite_items
from quintet.interfaces.component import Fields, Totals
from quintet.interfaces.sums import finite

DOUBTFUL_DEPTH = 0.2  # overlap over contact radius: stiff bodies overlap less
FEWEST_STEPS = 5  # of a contact
ALLOWED_DEPTH = 0.5  # overlap over contact radius; Hertz's law is for small ones


def failure(
    state: State, balls: BallPairs | None, others: BodyPairs, time: float
) -> tuple[str, Numbers]:
    """Say which body is wrong at a time [s], and what to do; return also where it is (3,) m."""
    after, bodies = f"dem_bodies, t = {time:.6g} s", len(state.body) - 1
    finite = np.isfinite(state.motion.sum(axis=1))[state.row]
    if not finite.all():
        k = int(np.argmin(finite))
        a = state.row[k]
        return (
            f"{after}: the state must stay finite; body {k} is at {state.position[a].tolist()} m "
            f"with {state.velocity[a].tolist()} m/s under a load of {state.load[a].tolist()} N, "
            "N m. Check its load, or increase steps_per_contact."
        ), state.position[a]
    i, j = deepest_pair(state, balls, others)
    other, where = f"body {j}" if j < bodies else "a plane", state.position[state.row[i]]
    return (
        f"{after}: the overlap of a contact must be at most {ALLOWED_DEPTH} of its radius; that of "
        f"body {i} with {other} is {state.report[DEEPEST]:.3g} of it, near "
        f"{where.round(4).tolist()} m. Increase youngs_modulus or edge_radius, or set impact_speed "
        "to the speed of the impacts."
    ), where


def check(state: State) -> None:
    """Refuse rotations that are not finite: without contacts no step reads them."""
    rows = state.row[:-1]
    fields = {"angular velocity": state.angular_velocity, "orientation": state.orientation}
    if all(finite(array) for array in fields.values()):
        return
    of_bodies = {name: array[rows] for name, array in fields.items()}
    advice = "Check the torques on it, or increase steps_per_contact."
    require_finite_items("body", of_bodies, np.arange(len(rows)), state.position[rows], advice)


@dataclass(slots=True)
class Accumulated:
    """Time, works and extremes of a run."""

    time: float = 0.0  # s
    dissipated: float = 0.0  # J, by dampers and friction
    load_work: float = 0.0  # J, done by the loads
    coarsest: float = 0.0  # longest step in contact, over the duration of that contact
    deepest: float = 0.0  # largest overlap over the radius of the contact

    def add(self, dt: float, elastic: float, report: Numbers) -> None:
        """Add a step of length dt [s]; `elastic` is the contacts' energy [J] before it."""
        lost = elastic - report[CONTACT_WORK] - report[ELASTIC_ENERGY]
        self.time += dt
        self.load_work += float(report[LOAD_WORK])
        self.dissipated += float(lost)
        duration = DURATION * SPEED_UP / math.sqrt(max(report[STIFFEST], 1e-300))  # s
        self.coarsest = max(self.coarsest, float(dt / duration))
        self.deepest = max(self.deepest, float(report[DEEPEST]))

    def warnings(self) -> dict[str, str]:
        """Warn of contacts that few steps resolved, and of deep overlaps."""
        warnings = {}
        if self.coarsest * FEWEST_STEPS > 1.0:
            warnings["steps"] = (
                f"a contact must last at least {FEWEST_STEPS} steps, or its rebound is wrong; the "
                f"shortest lasted {1.0 / self.coarsest:.2g}. Shorten fixed_step or leave it out, "
                "and set impact_speed to the speed of the fastest impact."
            )
        if self.deepest > DOUBTFUL_DEPTH:
            warnings["overlap"] = (
                f"bodies must overlap by less than {DOUBTFUL_DEPTH:g} of the radius of their "
                f"contact, as Hertz's law holds for small overlaps; found {self.deepest:.2g}. "
                "Increase youngs_modulus or edge_radius."
            )
        return warnings


def deepest_pair(state: State, balls: BallPairs | None, others: BodyPairs) -> tuple[int, int]:
    """Bodies of the deepest contact; planes are beyond all bodies."""
    pair, count = int(state.report[DEEPEST_PAIR]), 0 if balls is None else len(balls.partner)
    if balls is not None and pair < count:
        return ball_search.deepest_pair(state, balls)
    touching = others.touching
    i, j = state.body[touching[touching[:, 0] == pair - count][0, 1:3]]
    return int(i), int(j)


def contact_points(
    model: Model, state: State, balls: BallPairs | None, others: BodyPairs
) -> Fields:
    """List what touched in the last step, where the forces of pairs are kept.

    Returns
    -------
    bodies : (k, 2) the first body and the other; planes are the ground, beyond all bodies
    point, normal : (k, 3) m and 1, the normal towards the first body
    force : (k, 3) N on the first body
    depth : (k,) m, overlap
    """
    count = int(state.report[TOUCHING])
    geometry, bodies = others.geometry[:count], state.body[others.touching[:count, 1:3]]
    points = {
        "bodies": bodies,
        "point": geometry[:, 3:6],
        "normal": geometry[:, :3],
        "force": geometry[:, 8:],
        "depth": geometry[:, 6],
    }
    if balls is None:
        return {key: array.copy() for key, array in points.items()}
    of_balls = ball_search.touching_balls(model, state, balls)._asdict()
    return {key: np.concatenate([of_balls[key], array]) for key, array in points.items()}


def angular_momenta(model: Model, state: State) -> Numbers:
    """Angular momentum (n, 3) [kg m²/s] of each row about its centre."""
    momenta, ball = state.angular_momentum.copy(), model.ball
    momenta[ball] = (1.0 / model.inverse_moment[ball])[:, None] * state.angular_velocity[ball]
    if model.locked.any():
        write_momenta_of_locked(model, state, momenta)
    return momenta


def kinetic_energy(model: Model, state: State) -> float:
    """Kinetic energy [J] of all bodies, added up in the order of the rows."""
    v, ω, ball = state.velocity[:-1], state.angular_velocity[:-1], model.ball[:-1]
    momenta = np.where(ball[:, None], ω, angular_momenta(model, state)[:-1])
    rotation = 0.5 * inner(momenta, ω)
    rotation[ball] /= model.inverse_moment[:-1][ball]
    both = np.column_stack([0.5 * inner(v, v) / model.inverse_mass[:-1], rotation])
    return float(np.cumsum(both)[-1])


def inner(a: Numbers, b: Numbers) -> Numbers:
    """Inner products (n,) of the rows of two arrays (n, 3)."""
    return np.asarray(a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1] + a[:, 2] * b[:, 2])


def totals(model: Model, state: State, mass: Numbers) -> Totals:
    """Mass, momentum and energies of bodies of a mass (m,) kg; internal is elastic energy."""
    row = state.row[: len(mass)]
    x, momentum = state.position[row], mass[:, None] * state.velocity[row]
    angular_momentum = angular_momenta(model, state)[row]
    return Totals(
        mass=float(mass.sum()),
        momentum=momentum.sum(axis=0),
        angular_momentum=(angular_momentum + np.cross(x, momentum)).sum(axis=0),
        kinetic=kinetic_energy(model, state),
        potential=-float(mass @ (x @ model.gravity)),
        internal=float(state.report[ELASTIC_ENERGY]),
    )
