"""What is wrong when a run must end, and what touches where."""

import numpy as np

from quintet.components.dem_bodies.contact import ball_search
from quintet.components.dem_bodies.kernels.locked_motion import write_momenta_of_locked
from quintet.components.dem_bodies.state import (
    DEEPEST,
    DEEPEST_PAIR,
    TOUCHING,
    BallPairs,
    BodyPairs,
    Model,
    Numbers,
    State,
)
from quintet.interfaces.component import Fields
from quintet.interfaces.errors import StepError

DOUBTFUL_DEPTH = 0.2  # overlap over contact radius: more is not as stiff bodies do
FEWEST_STEPS = 5  # of a contact
ALLOWED_DEPTH = 0.5  # overlap over contact radius; Hertz's law is for small ones


def failure(state: State, balls: BallPairs | None, others: BodyPairs, time: float) -> StepError:
    """Say which body is wrong at a time [s], and what to do."""
    after, bodies = f"dem_bodies, t = {time:.6g} s", len(state.body) - 1
    finite = np.isfinite(state.motion.sum(axis=1))[state.row]
    if not finite.all():
        k = int(np.argmin(finite))
        a = state.row[k]
        return StepError(
            f"{after}: the state must stay finite; body {k} is at {state.position[a].tolist()} m "
            f"with {state.velocity[a].tolist()} m/s under a load of {state.load[a].tolist()} N, "
            "N m. Look at the load it was given, or make steps_per_contact larger."
        )
    i, j = deepest_pair(state, balls, others)
    other, where = f"body {j}" if j < bodies else "a plane", state.position[state.row[i]]
    return StepError(
        f"{after}: a contact may be {ALLOWED_DEPTH} of its radius deep; body {i} is "
        f"{state.report[DEEPEST]:.3g} of it deep in {other}, near {where.round(4).tolist()} m. "
        "Make youngs_modulus or edge_radius larger, or impact_speed nearer to that of impacts."
    )


def doubts(coarsest: float, deepest: float) -> dict[str, str]:
    """Say why contacts may be wrong.

    Parameters
    ----------
    coarsest : float, 1
        Longest step in contact over the duration of that contact.
    deepest : float, 1
        Largest overlap over the radius of the contact.
    """
    found = {}
    if coarsest * FEWEST_STEPS > 1.0:
        found["steps"] = (
            f"a contact must last {FEWEST_STEPS} steps or more, or its rebound is wrong; one "
            f"lasted {1.0 / coarsest:.2g}. Take a shorter fixed_step, or none, and an impact_speed "
            "that is that of the fastest impact."
        )
    if deepest > DOUBTFUL_DEPTH:
        found["overlap"] = (
            f"bodies must overlap by less than {DOUBTFUL_DEPTH:g} of the radius of their contact, "
            f"as Hertz's law is for small overlaps; found {deepest:.2g}. Make youngs_modulus or "
            "edge_radius larger."
        )
    return found


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
    listed = {
        "bodies": bodies,
        "point": geometry[:, 3:6],
        "normal": geometry[:, :3],
        "force": geometry[:, 8:],
        "depth": geometry[:, 6],
    }
    if balls is None:
        return {key: array.copy() for key, array in listed.items()}
    found = ball_search.touching_balls(model, state, balls)._asdict()
    return {key: np.concatenate([found[key], array]) for key, array in listed.items()}


def angular_momenta(model: Model, state: State) -> Numbers:
    """Angular momentum (n, 3) [kg m²/s] of each row about its centre."""
    momenta, ball = state.angular_momentum.copy(), model.ball
    momenta[ball] = (1.0 / model.inverse_moment[ball])[:, None] * state.angular_velocity[ball]
    if model.locked.any():
        write_momenta_of_locked(model, state, momenta)
    return momenta


def kinetic_energy(model: Model, state: State) -> float:
    """Kinetic energy [J] of all bodies, added up one by one: no bit depends on their number."""
    v, ω, ball = state.velocity[:-1], state.angular_velocity[:-1], model.ball[:-1]
    momenta = np.where(ball[:, None], ω, angular_momenta(model, state)[:-1])
    rotation = 0.5 * inner(momenta, ω)
    rotation[ball] /= model.inverse_moment[:-1][ball]
    both = np.column_stack([0.5 * inner(v, v) / model.inverse_mass[:-1], rotation])
    return float(np.cumsum(both)[-1])


def inner(a: Numbers, b: Numbers) -> Numbers:
    """Inner products (n,) of the rows of two arrays (n, 3)."""
    return np.asarray(a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1] + a[:, 2] * b[:, 2])
