"""Longest stable step of bodies at rest on each other and on planes, by their own contacts.

About a state of rest every contact is a spring and a damper, along its normal, along two tangents
and, of spheres with rolling resistance, about these: M dv/dt = -K x - C v. Velocity Verlet with
velocities that the last force predicts then obeys

    v⁺ - 2 v + v⁻ + dt² M⁻¹K v + dt M⁻¹C (v - v⁻) + dt/2 M⁻¹C (v - 2 v⁻ + v⁻⁻) = 0

and its first unstable motion changes sign in every step: (dt² K + 4 dt C - 4 M) v = 0. For a single
spring and damper (ω dt)² + 4 γ dt = 4: 2/ω without damping, 1/γ without a spring.
"""

import numpy as np

from quintet.components.dem_bodies.component import DemBodies
from quintet.components.dem_bodies.contact.expected import material_pairs
from quintet.components.dem_bodies.laws import DAMPING, ROLLING_DAMPING, ROLLING_STIFFNESS
from quintet.interfaces.component import Array


def longest_step(component: DemBodies) -> float:
    """Longest stable step [s] of bodies that rest, with `contact_forces` and free of locks."""
    mobility = inverse_masses(component)
    stiffness, damping = matrices(component, mobility)
    # With s = 1/dt: (4 s² M - 4 s C - K) v = 0.
    above = np.hstack([np.zeros_like(mobility), np.eye(len(mobility))])
    pencil = np.vstack([above, np.hstack([0.25 * mobility @ stiffness, mobility @ damping])])
    return float(1.0 / np.linalg.eigvals(pencil).real.max())


def inverse_masses(component: DemBodies) -> Array:
    """Inverse (6 n, 6 n) of all masses and inertias: velocity and angular velocity of each body."""
    model, state, count = component.model, component.state, component.count
    mobility = np.zeros((6 * count, 6 * count))
    for body, row in enumerate(state.row[:count]):
        place, turn = _places(body)
        mobility[place, place] = model.inverse_mass[row] * np.eye(3)
        if model.ball[row]:
            mobility[turn, turn] = model.inverse_moment[row] * np.eye(3)
        else:
            mobility[turn, turn] = _symmetric(state.world_inverse_inertia[row])
    return mobility


def matrices(component: DemBodies, mobility: Array) -> tuple[Array, Array]:
    """Stiffness and damping (6 n, 6 n) of all contacts."""
    points, properties = component.contact_points(), material_pairs(component.params)
    position = component.give(frozenset({"motion.position"}))
    stiffness, damping = np.zeros((2, *mobility.shape))
    keys = ("bodies", "normal", "force", "depth", "point")
    for pair, normal, force, depth, point in zip(*map(points.get, keys), strict=True):
        modulus, shear, ζ, μ, μ_r = properties[_materials(component, pair, normal)].tolist()
        push, slip, roll = motions(pair, normal, point, position["motion.position"])
        reduced = 1.0 / float((push @ mobility @ push.T).item())  # kg, m*
        along = 1.5 * float(force @ normal) / depth  # N/m, S_n: at rest no damper acts
        across = 4.0 * shear / modulus * along if μ > 0.0 else 0.0  # S_t
        springs = [(push, along, reduced), (slip, across, reduced)]
        dampers = [DAMPING * ζ * np.sqrt(spring * mass) for _, spring, mass in springs]
        if μ_r > 0.0:
            arm, inertia = _rolling(component, pair, μ_r)
            springs.append((roll, ROLLING_STIFFNESS * along * arm * arm, inertia))
            dampers.append(2.0 * ROLLING_DAMPING * np.sqrt(springs[-1][1] * inertia))
        for (motion, spring, _), damper in zip(springs, dampers, strict=True):
            stiffness += spring * motion.T @ motion
            damping += damper * motion.T @ motion
    return stiffness, damping


def motions(pair: Array, normal: Array, point: Array, position: Array) -> tuple[Array, ...]:
    """Rows that take all motions to those of a contact: (1, 6 n), (2, 6 n) and (2, 6 n)."""
    first = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    axes = np.stack([normal, first, np.cross(normal, first)])
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    rows, turns = np.zeros((2, 3, 6 * len(position)))
    for body, sign in zip(pair.tolist(), (1.0, -1.0), strict=True):
        if body < len(position):  # the ground does not move
            place, turn = _places(body)
            rows[:, place] = sign * axes
            rows[:, turn] = sign * np.cross(point - position[body], axes)
            turns[:, turn] = sign * axes
    return rows[:1], rows[1:], turns[1:]


def _materials(component: DemBodies, pair: Array, normal: Array) -> tuple[int, int]:
    """Numbers of the two materials of a contact; of the ground, that of its plane."""
    names, planes = list(component.params.materials), component.params.planes
    first, second = (int(body) for body in pair)
    if second < component.count:
        second_material = component.bodies[second].material
    else:
        normals = np.array([plane.normal for plane in planes])
        along = normals @ normal / np.linalg.norm(normals, axis=1)
        second_material = planes[int(np.argmax(along))].material
    return names.index(component.bodies[first].material), names.index(second_material)


def _rolling(component: DemBodies, pair: Array, μ_r: float) -> tuple[float, float]:
    """Arm [m] μ_r R* and inertia [kg m²] of two spheres, or of one on a plane, that roll."""
    bodies = [body for body in pair.tolist() if body < component.count]
    radius = np.array([component.bodies[body].radius for body in bodies])
    inertia = 1.4 * component.mass[bodies] * radius**2
    return float(μ_r / (1.0 / radius).sum()), float(1.0 / (1.0 / inertia).sum())


def _places(body: int) -> tuple[slice, slice]:
    return slice(6 * body, 6 * body + 3), slice(6 * body + 3, 6 * body + 6)


def _symmetric(row: Array) -> Array:
    xx, yy, zz, xy, xz, yz = row
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
