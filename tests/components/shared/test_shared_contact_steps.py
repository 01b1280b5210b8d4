"""Contact of particles with faces: the stable step, and spheres by Hertz's law."""

import numpy as np
import pytest
from contact_points import MODULUS, NODES, RADIUS, THICK, contact_of, points_at, spheres_at, take

from quintet.components.shared.contact.stable_step import highest_square


def _bounce(share, mass):
    """Growth of a displacement of a particle on a face of free nodes, at a share of our step."""
    node, face = NODES[[0, 1, 4, 3]], np.array([[0, 1, 2, 3]])
    depth = 1e-3
    contact = contact_of(1, node, face, mass=mass)
    node, node_velocity = node.copy(), np.zeros((4, 3))
    stiffness = 1.0 / (2.0 * RADIUS / MODULUS + THICK / MODULUS)
    points = points_at([(1.0, 1.0, RADIUS - 0.2 - depth)])
    push = stiffness * 0.2  # N, at 0.2 m
    take(contact, node)
    contact.kick(points, 0.0)
    dt, largest = share * contact.stable_step(1e9), 0.0
    for _ in range(400):
        take(contact, node)
        contact.kick(points, dt)
        points.velocity[0, 2] -= dt * push
        node_velocity = node_velocity + dt * contact.reaction / mass
        node_velocity[:, 2] += dt * 0.25 * push / mass
        points.place[:] += dt * points.velocity
        node = node + dt * node_velocity
        gap = points.place[0, 2] - node[:, 2].mean() - RADIUS
        largest = max(largest, abs(gap + 0.2))
        if largest > 0.1:
            break
    return largest / depth


@pytest.mark.parametrize("mass", [0.05, 0.25, 100.0])  # of a node
def test_the_predicted_step_of_contact_is_where_it_becomes_unstable(mass):
    assert _bounce(0.99, mass) < 20.0
    assert _bounce(1.01, mass) > 50.0


def _chain(layers, mass, particle, spring=0.5):
    """Highest ω² of a bar of layers, each with a spring of 1 N/m, that a particle touches.

    The spring of contact has `spring` N/m.
    """
    count = layers + 1
    stiffness, masses = np.zeros((count + 1, count + 1)), np.full(count + 1, mass)
    masses[[0, layers]] = 0.5 * mass
    masses[-1] = particle
    for k in range(layers):
        stiffness[k : k + 2, k : k + 2] += [[1.0, -1.0], [-1.0, 1.0]]
    stiffness[[0, 0, -1, -1], [0, -1, 0, -1]] += spring * np.array([1.0, -1.0, -1.0, 1.0])
    root = np.sqrt(masses)
    return float(np.linalg.eigvalsh(stiffness / root / root[:, None])[-1])


@pytest.mark.parametrize("layers", [1, 2, 20])
@pytest.mark.parametrize("particle", [0.1, 1.0, 10.0])
@pytest.mark.parametrize("spring", [0.05, 0.5, 2.0, 10.0])
def test_the_bound_of_both_sides_and_contact_is_above_the_exact_frequency(layers, particle, spring):
    contact_terms = spring / particle, spring / 0.5
    exact, bound = _chain(layers, 1.0, particle, spring), highest_square((0.0, 4.0), contact_terms)
    assert exact <= bound * (1.0 + 1e-12)
    assert bound < 1.2 * exact
    assert bound <= 4.0 + sum(contact_terms)


def test_the_bound_is_exact_for_one_layer_on_a_heavy_particle():
    exact = _chain(1, 1.0, 1e12)
    assert highest_square((0.0, 4.0), (0.5e-12, 1.0)) == pytest.approx(exact, rel=1e-9)
    assert highest_square((0.0, 0.0), (3.0, 4.0)) == pytest.approx(7.0)


def _roll(share, mass):
    """Energies over the first one of a sphere that sticks to a face, at a share of our step."""
    node, face = NODES[[0, 1, 4, 3]].copy(), np.array([[0, 1, 2, 3]])
    contact = contact_of(1, node, face, mass=mass, friction=1e6, spheres=True)
    points, face_speed, energies = spheres_at([(1.0, 1.0, RADIUS - 1e-3)]), 0.0, []
    take(contact, node)
    contact.kick(points, 0.0)
    points.velocity[:] = 0.0
    dt = share * contact.stable_step(1e9)
    points.velocity[0] = 1e-6, 0.0, 0.0
    for _ in range(400):
        take(contact, node)
        contact.kick(points, dt)
        points.velocity[0, 2] = 0.0  # held in height
        face_speed += dt * contact.reaction[:, 0].sum() / (4.0 * mass)
        node[:, 0] += dt * face_speed
        points.place[0, 0] += dt * points.velocity[0, 0]
        spin = (points.spin[0, 1] * RADIUS) ** 2 / 2.5
        energies.append(points.velocity[0, 0] ** 2 + spin + 4.0 * mass * face_speed**2)
    return np.array(energies) / 1e-12


@pytest.mark.parametrize("mass", [0.25, 1e9])  # of a node
def test_the_predicted_step_is_where_a_sphere_that_sticks_becomes_unstable(mass):
    energies = _roll(0.95, mass)
    # Velocities at mid-step exceed those of the motion by 1/√(1 - (ω dt/2)²).
    assert energies.max() < 1.0 / (1.0 - 0.95**2)
    assert energies[200:].max() < 1.01 * energies[:200].max()
    assert _roll(1.01, mass).max() > 1e3


def test_a_sphere_is_pushed_by_hertz_and_holds_his_energy():
    modulus, mass = 0.5 * MODULUS, 1e-3  # Pa, E* of both; kg
    for depth in (1e-5, 1e-3):
        contact, points = (
            contact_of(1, spheres=True),
            spheres_at([(1, 1, RADIUS - depth)], mass=mass),
        )
        take(contact)
        contact.kick(points, 1e-3)
        force = 4.0 / 3.0 * modulus * RADIUS**0.5 * depth**1.5
        assert points.velocity[0, 2] * mass / 1e-3 == pytest.approx(force, rel=1e-12)
        assert contact.numbers.energy == pytest.approx(0.4 * force * depth, rel=1e-12)
        stiffness = 2.0 * modulus * (RADIUS * depth) ** 0.5
        assert contact.numbers.impact == pytest.approx(stiffness / mass, rel=1e-12)


def test_the_step_of_a_sphere_foresees_how_deep_it_will_come():
    speed, mass, modulus = 0.1, 1e-3, 0.5 * MODULUS
    contact = contact_of(1, mass=1e9, spheres=True)
    points = spheres_at([(1.0, 1.0, 1.5 * RADIUS)], np.array([[0.0, 0.0, -speed]]), mass)
    take(contact)
    contact.kick(points, 1e-3)
    deepest = (15.0 * mass * speed**2 / (16.0 * modulus * RADIUS**0.5)) ** 0.4
    stiffest = 2.0 * modulus * (RADIUS * deepest) ** 0.5
    assert contact.numbers.impact == pytest.approx(stiffest / mass, rel=1e-12)
    dt = 2.0 / (stiffest / mass) ** 0.5
    assert contact.stable_step(1e9) == pytest.approx(dt, rel=1e-6)


def test_wide_contact_of_a_sphere_is_warned_of():
    contact = contact_of(1, spheres=True)
    for depth, warns in ((0.07, False), (0.09, True)):  # √(R δ) is 0.187 and 0.212 m
        take(contact)
        contact.kick(spheres_at([(1.0, 1.0, RADIUS - depth)]), 1e-3)
        assert ("indentation" in contact.warnings()) == warns
    assert "found 0.21. Take larger elements" in contact.warnings()["indentation"]


def test_no_energy_appears_as_a_loaded_tangential_spring_changes_its_stiffness():
    # A sphere is pressed in, sheared, pressed deeper and let go: its spring loses energy only.
    contact = contact_of(1, friction=1e6, spheres=True)
    points, work, last_force = spheres_at([(1.0, 1.0, RADIUS)]), 0.0, np.zeros(3)
    path = [(0.0, 1e-2), (1e-3, 1e-2), (1e-3, 4e-2), (1e-3, 1e-2), (2e-3, 1e-2), (2e-3, 1e-3)]
    x, steps = np.array([0.0, 0.0]), 200
    for target in map(np.array, path):
        move = (target - x) / steps
        for _ in range(steps):
            x = x + move
            points.place[0] = 1.0 + x[0], 1.0, RADIUS - x[1]
            points.velocity[0], points.spin[:] = (move[0], 0.0, -move[1]), 0.0
            take(contact)
            contact.kick(points, 1.0)
            force = points.velocity[0] - (move[0], 0.0, -move[1])
            work -= 0.5 * (force + last_force) @ (move[0], 0.0, -move[1])
            last_force = force
    dissipated = contact.numbers.dissipated
    assert dissipated > 0.0
    assert work == pytest.approx(contact.numbers.energy + dissipated, rel=2e-3)


def test_a_particle_near_a_face_limits_the_step_before_it_touches():
    contact = contact_of(2)
    for height, limits in ((1.2, False), (0.9, True)):
        take(contact)
        contact.kick(points_at([(1.0, 1.0, height), (9.0, 9.0, 9.0)]), 1e-3)
        assert np.isfinite(contact.stable_step(1.0)) == limits
