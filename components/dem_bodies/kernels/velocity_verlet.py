"""The two halves of a velocity-Verlet step: half kick and drift, and the second half kick."""

from numba import njit

from quintet.components.dem_bodies.kernels.ball_laws import drifted, half_kick
from quintet.components.dem_bodies.kernels.geometry import (
    quaternion,
    rotation_matrix,
    row_vector,
    set_quaternion,
    set_row_vector,
    set_vector,
    vector,
)
from quintet.components.dem_bodies.kernels.kicks import kick_body, kick_rotation
from quintet.components.dem_bodies.kernels.locked_motion import rotate_locked, turns_evenly
from quintet.components.dem_bodies.kernels.rigid_rotation import rotate_body, symmetric_product
from quintet.components.dem_bodies.state import (
    ACCELERATION2,
    BLOCK,
    CENTRIPETAL,
    COLUMNS,
    CONTACT_WORK,
    END_OMEGA,
    END_VELOCITY,
    LOAD_WORK,
    OMEGA,
    RADIUS,
    ROTATION2,
    SPIN_UP2,
    TRAVEL,
    VELOCITY,
    VELOCITY2,
    BallPairs,
    Model,
    Numbers,
    Short,
    State,
    Whole,
)
from quintet.components.shared.numba_options import INNER
from quintet.components.shared.rotations import axpy, dot, scaled, sub, to_world


@njit(**INNER)
def drift_balls(
    start: int, end: int, gravity: Numbers, inverse_mass: Numbers, inverse_moment: Numbers,
    motion: Numbers, contact: Numbers, load: Numbers, orientation: Numbers, listed: Numbers,
    dt: float, loaded: bool,
) -> tuple[float, float, float]:  # fmt: skip
    """Drift of the balls in rows [start, end): works [J], largest displacement squared [m²].

    All arrays are flat. None is handed on in a branch, or references are counted in the loop.
    """
    half, half_gravity = 0.5 * dt, scaled(0.5 * dt, vector(gravity, 0))
    work, load_work, furthest = 0.0, 0.0, 0.0
    for i in range(start, end):
        m, c, to = COLUMNS * i, 6 * i, 6 * i if loaded else 0
        force, torque = vector(contact, c), vector(contact, c + 3)
        load_force, load_torque = vector(load, to), vector(load, to + 3)
        before = vector(motion, m + OMEGA)
        v, ω, change, done, by_load = half_kick(
            vector(motion, m + VELOCITY), before, half_gravity, half, inverse_mass[i],
            inverse_moment[i], force, torque, load_force, load_torque,
        )  # fmt: skip
        work, load_work = work + done, load_work + by_load
        x, q, end_v, end_ω = drifted(
            vector(motion, m), quaternion(orientation, 4 * i), v, change, before, ω, dt
        )
        set_vector(motion, m, x)
        set_vector(motion, m + VELOCITY, v)
        set_vector(motion, m + OMEGA, ω)
        set_vector(motion, m + END_VELOCITY, end_v)
        set_vector(motion, m + END_OMEGA, end_ω)
        set_quaternion(orientation, 4 * i, q)
        moved = sub(x, vector(listed, 3 * i))
        furthest = max(furthest, dot(moved, moved))
    return work, load_work, furthest


@njit(**INNER)
def place_spheres(model: Model, state: State, i: int) -> float:
    """Place the spheres of a body that is no ball; return the largest displacement squared."""
    furthest = 0.0
    centre, listed, x = state.centre, state.listed_centre, row_vector(state.motion, i)
    for s in range(model.sphere_begin[i], model.sphere_begin[i + 1]):
        a, b, c = row_vector(model.sphere_centre, s)
        placed = axpy(1.0, to_world(rotation_matrix(state.axes, i), a, b, c), x)
        set_row_vector(centre, s, 0, placed)
        moved = sub(placed, row_vector(listed, s))
        furthest = max(furthest, dot(moved, moved))
    return furthest


@njit(**INNER)
def drift_body(model: Model, state: State, i: int, dt: float) -> tuple[float, float, float]:
    """Drift of a body that is no ball: works [J] and the largest displacement squared [m²]."""
    half, motion = 0.5 * dt, state.motion
    change, _, work, load_work = kick_body(model, state, i, half)
    v = row_vector(motion, i, VELOCITY)
    set_row_vector(motion, i, 0, axpy(dt, v, row_vector(motion, i)))
    set_row_vector(motion, i, END_VELOCITY, axpy(1.0, change, v))
    if model.locked[i]:
        set_row_vector(motion, i, OMEGA, rotate_locked(model, state, i, dt))
    else:
        set_row_vector(motion, i, OMEGA, rotate_body(model, state, i, dt))
    torque, load_torque = row_vector(state.contact_load, i, 3), row_vector(state.load, i, 3)
    # The inverse inertia of a locked body leaves out what torques do about locked axes.
    x, y, z = kick_rotation(row_vector(state.angular_momentum, i), half, torque, load_torque)
    end_ω = symmetric_product(state.world_inverse_inertia, i, x, y, z)
    if model.locked[i] and turns_evenly(model, i):
        end_ω = row_vector(motion, i, OMEGA)
    set_row_vector(motion, i, END_OMEGA, end_ω)
    return work, load_work, place_spheres(model, state, i)


@njit(**INNER)
def drift(
    first: int, last: int, model: Model, state: State, pairs: BallPairs | None, sums: Numbers,
    dt: float, loaded: bool,
) -> None:  # fmt: skip
    """Half kick, then move the bodies of the blocks [first, last) and their spheres.

    Velocity and angular momentum are left at the middle of the step. Dampers need a velocity at
    its end: it is predicted with the forces of the step's beginning, which keeps second order.

    Parameters
    ----------
    first, last : int
        Blocks of rows.
    model, state
        All bodies; motion, orientations and centres of `state` are advanced.
    pairs : BallPairs or None
        None if there are no balls.
    sums : (blocks, SUMS)
        Works and displacements of each block are written.
    dt : float, s
    loaded : bool
        Whether any body has a load.

    References
    ----------
    Swope, Andersen, Berens & Wilson (1982), J. Chem. Phys. 76, 637 (velocity Verlet).
    """
    bodies = model.bounding_radius.shape[0]
    balls = bodies - model.others.shape[0]
    if pairs is not None:
        motion, contact = state.motion.reshape(-1), state.contact_load.reshape(-1)
        load, orientation = state.load.reshape(-1), state.orientation.reshape(-1)
        listed = state.listed_centre.reshape(-1)
    for block in range(first, last):
        start, end = block * BLOCK, min((block + 1) * BLOCK, bodies)
        work, load_work, furthest = 0.0, 0.0, 0.0
        if pairs is not None:
            work, load_work, furthest = drift_balls(
                start, min(end, balls), model.gravity, model.inverse_mass, model.inverse_moment,
                motion, contact, load, orientation, listed, dt, loaded,
            )  # fmt: skip
            if balls < bodies:
                for i in range(start, min(end, balls)):
                    set_row_vector(state.centre, i, 0, row_vector(state.motion, i))
        for i in range(max(start, balls), end):
            done, by_load, moved = drift_body(model, state, i, dt)
            work, load_work, furthest = work + done, load_work + by_load, max(furthest, moved)
        sums[block, CONTACT_WORK], sums[block, LOAD_WORK] = work, load_work
        sums[block, TRAVEL] = furthest


@njit(**INNER)
def add_incoming(
    start: int, end: int, contact: Numbers, outgoing: Numbers, begin: Whole, incoming: Short
) -> None:
    """Add the loads that pairs of earlier blocks have on the rows [start, end)."""
    for i in range(start, end):
        c, force, torque = 6 * i, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
        for place in range(begin[i], begin[i + 1]):
            k = 6 * incoming[place]
            force = axpy(1.0, vector(outgoing, k), force)
            torque = axpy(1.0, vector(outgoing, k + 3), torque)
        set_vector(contact, c, axpy(1.0, force, vector(contact, c)))
        set_vector(contact, c + 3, axpy(1.0, torque, vector(contact, c + 3)))


@njit(**INNER)
def end_kick_balls(
    start: int, end: int, gravity: Numbers, inverse_mass: Numbers, inverse_moment: Numbers,
    motion: Numbers, contact: Numbers, load: Numbers, half: float, loaded: bool,
) -> tuple[float, float, float, float, float]:  # fmt: skip
    """Half kick of the balls in rows [start, end): works [J] and how fast they move."""
    half_gravity = scaled(half, vector(gravity, 0))
    work, load_work, velocity2, rotation2, centripetal = 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(start, end):
        m, c, to = COLUMNS * i, 6 * i, 6 * i if loaded else 0
        force, torque = vector(contact, c), vector(contact, c + 3)
        load_force, load_torque = vector(load, to), vector(load, to + 3)
        v, ω, _, done, by_load = half_kick(
            vector(motion, m + VELOCITY), vector(motion, m + OMEGA), half_gravity, half,
            inverse_mass[i], inverse_moment[i], force, torque, load_force, load_torque,
        )  # fmt: skip
        set_vector(motion, m + VELOCITY, v)
        set_vector(motion, m + OMEGA, ω)
        work, load_work = work + done, load_work + by_load
        radius, ω2 = motion[m + RADIUS], dot(ω, ω)
        velocity2, rotation2 = max(velocity2, dot(v, v)), max(rotation2, radius * radius * ω2)
        centripetal = max(centripetal, radius * ω2)
    return work, load_work, velocity2, rotation2, centripetal


@njit(**INNER)
def load_accelerations(start: int, end: int, model: Model, state: State) -> tuple[float, float]:
    """Squares [m²/s⁴] of the largest accelerations: by gravity and loads, and by their torques."""
    gravity, largest, rotation = vector(model.gravity, 0), 0.0, 0.0
    for i in range(start, end):
        pull = axpy(model.inverse_mass[i], row_vector(state.load, i), gravity)
        x, y, z = row_vector(state.load, i, 3)
        up = symmetric_product(state.world_inverse_inertia, i, x, y, z)
        largest = max(largest, dot(pull, pull))
        rotation = max(rotation, model.bounding_radius[i] ** 2 * dot(up, up))
    return largest, rotation


@njit(**INNER)
def end_kick(
    block: int, model: Model, state: State, pairs: BallPairs | None, sums: Numbers, dt: float,
    loaded: bool,
) -> None:  # fmt: skip
    """Half kick of a block's rows with the new forces; how fast all move.

    Parameters
    ----------
    block : int
    model, state
        All bodies; velocities and contact loads of the block's rows are advanced.
    pairs : BallPairs or None
        Their `outgoing` loads on this block have all come. None if there are no balls.
    sums : (blocks, SUMS)
        Works and largest speeds of the block are written.
    dt : float, s
    loaded : bool
        Whether any body has a load.
    """
    half, gravity, bodies = 0.5 * dt, vector(model.gravity, 0), model.bounding_radius.shape[0]
    start, end, balls = block * BLOCK, min((block + 1) * BLOCK, bodies), bodies
    balls -= model.others.shape[0]
    work, load_work, velocity2, rotation2, centripetal = 0.0, 0.0, 0.0, 0.0, 0.0
    if pairs is not None:
        motion, contact = state.motion.reshape(-1), state.contact_load.reshape(-1)
        load, outgoing = state.load.reshape(-1), pairs.outgoing.reshape(-1)
        add_incoming(start, end, contact, outgoing, pairs.incoming_begin, pairs.incoming)
        work, load_work, velocity2, rotation2, centripetal = end_kick_balls(
            start, min(end, balls), model.gravity, model.inverse_mass, model.inverse_moment,
            motion, contact, load, half, loaded,
        )  # fmt: skip
    for i in range(max(start, balls), end):
        _, ω, done, by_load = kick_body(model, state, i, half)
        work, load_work = work + done, load_work + by_load
        v, radius, ω2 = row_vector(state.motion, i, VELOCITY), state.motion[i, RADIUS], dot(ω, ω)
        velocity2, rotation2 = max(velocity2, dot(v, v)), max(rotation2, radius * radius * ω2)
        centripetal = max(centripetal, radius * ω2)
    acceleration2, spin_up2 = dot(gravity, gravity), 0.0
    if loaded:
        largest, spin_up2 = load_accelerations(start, end, model, state)
        acceleration2 = max(acceleration2, largest)
    sums[block, CONTACT_WORK] += work
    sums[block, LOAD_WORK] += load_work
    sums[block, VELOCITY2], sums[block, ROTATION2] = velocity2, rotation2
    sums[block, ACCELERATION2], sums[block, SPIN_UP2] = acceleration2, spin_up2
    sums[block, CENTRIPETAL] = centripetal
