"""Spheres: exact flight, launches, impacts with walls and each other."""

import numpy as np
import pytest

from quintet.components.particle_dynamics.component import ParticleDynamics
from quintet.components.particle_dynamics.params import (
    Lattice,
    ParticleDynamicsParams,
    SevenRootForce,
)
from quintet.components.particle_dynamics.spheres.params import Sphere, Wall

G = (0.0, 0.0, -9.81)  # m/s2


def spheres(*given, **keys):
    made = tuple(Sphere(**({"diameter": 0.02, "density": 1000.0} | one)) for one in given)
    return ParticleDynamics(ParticleDynamicsParams(spheres=made, **keys))


def test_flight_under_constant_loads_is_exact_at_any_step():
    made = spheres({"position": (0.0, 0.0, 1.0), "velocity": (2.0, 0.0, 3.0)}, gravity=G)
    mass = made.totals().mass
    made.take({"load.force": np.array([[mass, 0.0, 0.0]]), "heat.heat_flow": np.array([5.0])})
    for _ in range(3):
        made.step(0.1)
    found = made.give({"motion.position", "spheres.temperature"})
    exact = np.array([[0.6 + 0.5 * 0.09, 0.0, 1.0 + 0.9 - 0.5 * 9.81 * 0.09]])
    assert found["motion.position"] == pytest.approx(exact, abs=1e-14)
    assert found["spheres.temperature"][0] == pytest.approx(300.0 + 1.5 / (1000.0 * mass))


def test_a_torque_turns_a_sphere_by_its_moment_of_inertia():
    made = spheres({"position": (0.0, 0.0, 0.0)})
    inertia = 0.4 * made.totals().mass * 0.01**2
    made.take({"load.torque": np.array([[0.0, 0.0, 2.0 * inertia]])})
    for _ in range(10):
        made.step(0.05)
    found = made.give({"motion.orientation", "motion.angular_velocity"})
    assert found["motion.angular_velocity"][0] == pytest.approx([0.0, 0.0, 1.0])
    half = 0.125  # rad, half of t2
    turned = [np.cos(half), 0.0, 0.0, np.sin(half)]
    assert found["motion.orientation"][0] == pytest.approx(turned, abs=1e-12)


def test_a_sphere_rests_until_it_is_launched_within_a_step():
    made = spheres({"position": (0.0, 0.0, 0.0), "velocity": (1.0, 0.0, 0.0), "launch": 0.25})
    made.take({"load.force": np.array([[1.0, 0.0, 0.0]]) * 0.0})
    made.step(0.2)
    assert made.give({"motion.velocity"})["motion.velocity"][0, 0] == 0.0
    made.step(0.1)
    assert made.give({"motion.position"})["motion.position"][0, 0] == pytest.approx(0.05)
    made.step(0.1)
    assert made.give({"motion.position"})["motion.position"][0, 0] == pytest.approx(0.15)


@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
def test_impacts_keep_momentum_and_lose_what_restitution_says(restitution):
    made = spheres(
        {"position": (0.0, 0.0, 0.0), "velocity": (1.0, 0.2, 0.0)},
        {"position": (0.03, 0.0, 0.0), "velocity": (-1.0, 0.0, 0.0), "density": 3000.0},
        restitution=restitution,
    )
    start = made.totals()
    for _ in range(200):
        made.step(1e-4)
    end = made.totals()
    assert end.momentum == pytest.approx(start.momentum, abs=1e-15)
    assert end.angular_momentum == pytest.approx(start.angular_momentum, abs=1e-15)
    assert end.kinetic + end.internal == pytest.approx(start.kinetic, rel=1e-12)
    velocity = made.give({"motion.velocity"})["motion.velocity"]
    line = np.diff(made.give({"motion.position"})["motion.position"], axis=0)[0]
    apart = np.diff(velocity, axis=0)[0] @ line / np.linalg.norm(line)
    assert apart == pytest.approx(2.0 * restitution, abs=0.1)


def test_a_sphere_bounces_from_a_wall():
    made = spheres(
        {"position": (0.0, 0.0, 0.1), "velocity": (0.5, 0.0, -1.0)},
        walls=(Wall(normal=(0.0, 0.0, 2.0)),),
        restitution=0.6,
    )
    for _ in range(1000):
        made.step(2e-4)
    assert made.give({"motion.velocity"})["motion.velocity"][0] == pytest.approx([0.5, 0.0, 0.6])


def test_parameters_are_of_a_lattice_or_of_spheres():
    lattice = Lattice(cells=(1, 1, 1), spacing=1.0, mass=1.0)
    force = SevenRootForce(top_frequency=1.0)
    one = Sphere(position=(0.0, 0.0, 0.0), diameter=1.0, density=1.0)
    with pytest.raises(ValueError, match="give lattice or spheres"):
        ParticleDynamicsParams()
    with pytest.raises(ValueError, match="give lattice or spheres"):
        ParticleDynamicsParams(lattice=lattice, spheres=(one,), seven_roots=force)
    with pytest.raises(ValueError, match="of lattices only"):
        ParticleDynamicsParams(spheres=(one,), seven_roots=force)
