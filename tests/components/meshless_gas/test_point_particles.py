"""Point particles and nodes: conservation, exact relaxation and terminal speed."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from quintet.components.meshless_gas.clouds.box import box
from quintet.components.meshless_gas.kernels.ghosts import write_ghost_states
from quintet.components.meshless_gas.kernels.motion import STAGES, advance, write_conservative
from quintet.components.meshless_gas.laws.transport import Transport
from quintet.components.meshless_gas.particle_coupling import PointParticles
from quintet.components.meshless_gas.point_particles import laws
from quintet.components.meshless_gas.point_particles.interphase import InterphaseExchange
from quintet.components.meshless_gas.point_particles.particles import Particles

GAMMA, GAS_CONSTANT, PRANDTL = 1.4, 287.05, 0.72
PRESSURE, TEMPERATURE = 1e5, 300.0
DENSITY = PRESSURE / (GAS_CONSTANT * TEMPERATURE)
SOUND = math.sqrt(GAMMA * GAS_CONSTANT * TEMPERATURE)
CAPACITY = GAS_CONSTANT / (GAMMA - 1.0)  # J/(kg K) at constant volume
VISCOSITY = 1.8e-5
TRANSPORT = Transport(VISCOSITY, 300.0, -1.0, GAMMA * CAPACITY / PRANDTL, GAS_CONSTANT)
SIZE, MATERIAL, WARMTH = 1e-5, 2000.0, 900.0  # m, kg/m3, J/(kg K)
MASS = MATERIAL * math.pi * SIZE**3 / 6.0
RELAXES = MATERIAL * SIZE**2 / (18.0 * VISCOSITY)  # s, by the drag of Stokes
SIDE = {"x-": "periodic", "x+": "periodic", "y-": "periodic", "y+": "periodic"}
PERIODIC = SIDE | {"z-": "periodic", "z+": "periodic"}
PATCHES = dict.fromkeys(PERIODIC, 0)


class Gas:
    """Nodes without fluxes, changed by particles alone."""

    def __init__(self, faces=PERIODIC, planar=True, spacing=0.1, jitter=0.3, **overrides):
        high = (1.0, 1.0, 1.0)
        self.cloud = box(
            (0.0, 0.0, 0.0), high, spacing, faces, PATCHES, jitter=jitter, seed=3, planar=planar
        )
        count = len(self.cloud.positions)
        self.primitive = np.zeros((count, 5))
        self.primitive[:, 0], self.primitive[:, 4] = DENSITY, PRESSURE
        self.conservative = np.zeros((count, 5))
        keys = {"drag": "stokes", "heat": "still"} | overrides
        self.exchange = InterphaseExchange(
            PointParticles(**keys), self.cloud, planar, TRANSPORT, GAMMA, PRANDTL
        )

    @property
    def volumes(self):
        return self.cloud.volumes[: self.cloud.nodes, None]

    def content(self):
        """Mass, momentum and energy."""
        return (self.conservative[: self.cloud.nodes] * self.volumes).sum(axis=0)

    def step(self, particles, dt):
        """One step of SSP-RK3; loads are in the exchange."""
        cloud, rows = self.cloud, np.arange(self.cloud.nodes)
        write_conservative(self.primitive, GAMMA, self.conservative)
        start = self.conservative.copy()
        self.exchange.place(particles)
        for old, new, share in STAGES:
            write_ghost_states(0, len(cloud.owner), cloud.owner, cloud.turn, self.primitive)
            residual = np.zeros_like(start)
            self.exchange.add(self.primitive, residual, dt, (old, new, share))
            advance(
                0, len(rows), rows, start, residual, dt, None, old, new, GAMMA,
                self.conservative, self.primitive,
            )  # fmt: skip


def dust(position, velocity=(0.0, 0.0, 0.0), temperature=TEMPERATURE, number=1.0):
    position = np.atleast_2d(np.array(position, float))
    count = len(position)
    return Particles(
        position=position,
        velocity=np.tile(np.array(velocity, float), (count, 1)),
        acceleration=np.zeros((count, 3)),
        temperature=np.full(count, temperature),
        diameter=np.full(count, SIZE),
        launched=np.ones(count),
        mass=np.full(count, number * MASS),
        heat_capacity=np.full(count, number * MASS * WARMTH),
        number=np.full(count, number),
    )


def scattered(count, seed=1):
    return np.random.default_rng(seed).uniform(0.0, 1.0, (count, 3))


def test_weights_are_shares_of_one_and_change_continuously():
    gas = Gas()
    places = np.linspace([0.31, 0.2, 0.43], [0.52, 0.2, 0.61], 2001)
    gas.exchange.place(dust(places))
    field = gas.cloud.positions[:, 0] - 2.0 * gas.cloud.positions[:, 2]
    interpolated = (gas.exchange.weights * field[gas.exchange.near]).sum(axis=1)
    assert gas.exchange.weights.sum(axis=1) == pytest.approx(1.0, abs=1e-14)
    assert gas.exchange.weights.min() >= 0.0
    assert np.abs(np.diff(interpolated)).max() < 5.0 * 0.6 / 2000
    exact = places[:, 0] - 2.0 * places[:, 2]
    assert np.abs(interpolated - exact).max() < 0.5 * 0.1 * math.sqrt(5.0)


def test_particles_before_their_launch_are_not_there():
    gas = Gas(drag="loth")
    particles = dust([[0.3, 0.0, 0.5], [0.7, 0.0, 0.5]], velocity=(30.0, 0.0, 0.0))
    gas.step(particles._replace(launched=np.array([1.0, 0.0])), 1e-6)
    assert gas.exchange.loads.force[0, 0] < 0.0
    assert not gas.exchange.loads.force[1].any()
    assert not gas.exchange.loads.rates[1].any()


def test_particles_beyond_the_nodes_feel_nothing():
    gas = Gas({**PERIODIC, "x-": "outflow", "x+": "outflow"})
    gas.step(dust([[0.5, 0.0, 0.5], [1.4, 0.0, 0.5]], velocity=(30.0, 0.0, 0.0)), 1e-6)
    assert gas.exchange.loads.force[0, 0] < 0.0
    assert not gas.exchange.loads.force[1].any()


@pytest.mark.parametrize("planar", [True, False])
@pytest.mark.parametrize("drag", ["loth", "henderson"])
def test_what_particles_get_the_nodes_lose_to_rounding(planar, drag):
    gas = Gas(planar=planar, spacing=0.1 if planar else 0.25, drag=drag, heat="fox")
    random = np.random.default_rng(4)
    gas.primitive *= random.uniform(0.9, 1.1, gas.primitive.shape)
    gas.primitive[:, 1:4] = random.normal(0.0, 30.0, (len(gas.primitive), 3))
    if planar:
        gas.primitive[:, 2] = 0.0
    particles = dust(scattered(200), number=1e7)
    speeds = random.normal(0.0, 300.0, (200, 3))
    particles = particles._replace(velocity=speeds, temperature=random.uniform(250.0, 800.0, 200))
    write_conservative(gas.primitive, GAMMA, gas.conservative)
    before, dt = gas.content(), 2e-6
    gas.step(particles, dt)
    lost = (gas.content() - before) / dt
    force, heat = gas.exchange.loads.force, gas.exchange.loads.heat
    power = float(gas.exchange.loads.power.sum())
    scale = np.abs(force).sum()
    assert np.abs(lost[1:4] + force.sum(axis=0)).max() < 1e-9 * scale  # cancelled from 1e5 larger
    assert abs(lost[0]) * dt < 1e-13 * before[0]
    assert lost[4] + power == pytest.approx(0.0, abs=1e-9 * abs(power))
    # The sources themselves, without the state that they are added to.
    residual = np.zeros_like(gas.primitive)
    gas.exchange.place(particles)
    gas.exchange.add(gas.primitive, residual, 0.0, (0.0, 1.0, 1.0))
    summed = (residual[: gas.cloud.nodes] * gas.volumes).sum(axis=0)
    force, heat = gas.exchange.loads.force, gas.exchange.loads.heat
    power = (force * speeds).sum() + heat.sum()
    assert np.abs(summed[1:4] + force.sum(axis=0)).max() < 1e-13 * np.abs(force).sum()
    assert summed[4] == pytest.approx(-power, rel=1e-12)
    assert not residual[gas.cloud.nodes :].any()


def test_a_plane_of_symmetry_takes_what_pushes_into_it_alone():
    gas = Gas({**PERIODIC, "z-": "symmetry", "z+": "symmetry"})
    gas.exchange.place(dust([0.5, 0.0, 0.01], velocity=(10.0, 0.0, 5.0), number=1e6))
    residual = np.zeros_like(gas.primitive)
    gas.exchange.add(gas.primitive, residual, 0.0, (0.0, 1.0, 1.0))
    lost = (residual[: gas.cloud.nodes] * gas.volumes).sum(axis=0)
    force, heat = gas.exchange.loads.force[0], gas.exchange.loads.heat[0]
    assert lost[1] == pytest.approx(-force[0], rel=1e-13)
    assert lost[4] == pytest.approx(-(force @ [10.0, 0.0, 5.0] + heat), rel=1e-12)
    assert 0.0 < abs(lost[3]) < 0.5 * abs(force[2])  # the images push back


def relax(gas, particles, end, dt):
    """Move particles by the mean loads of each step; the gas sees them at its start."""
    for _ in range(round(end / dt)):
        gas.step(particles, dt)
        particles = particles._replace(
            position=particles.position + dt * particles.velocity,
            velocity=particles.velocity + dt * gas.exchange.loads.force / particles.mass[:, None],
            temperature=particles.temperature
            + dt * gas.exchange.loads.heat / particles.heat_capacity,
        )
    return particles.velocity, particles.temperature


def test_a_particle_relaxes_to_the_gas_in_the_time_of_stokes():
    gas = Gas(reaction=False)
    gas.primitive[:, 1] = 20.0
    end = 1.5 * RELAXES
    v, warm = relax(gas, dust([0.5, 0.0, 0.5], temperature=400.0), end, RELAXES / 50.0)
    assert v[0, 0] / 20.0 == pytest.approx(1.0 - math.exp(-1.5), rel=5e-3)
    rate = 6.0 * TRANSPORT.conduction * VISCOSITY / (WARMTH * MATERIAL * 0.5 * SIZE**2)
    assert (warm[0] - 300.0) / 100.0 == pytest.approx(math.exp(-rate * end), rel=5e-3)


@pytest.mark.parametrize("drag", ["stokes", "clift_gauvin", "henderson", "loth"])
def test_a_particle_falls_with_its_terminal_speed(drag):
    """3π μ d f(Re) v = m g: heavy enough that the Reynolds number is 40 to 100."""
    gas = Gas(reaction=False, drag=drag)
    pull = 3e5  # m/s2
    end, dt = 12.0 * RELAXES, RELAXES / 20.0
    # Held where it is, so that it stays among the nodes.
    fall = np.array([0.0, 0.0, -pull])
    still, speed = dust([0.5, 0.0, 0.5])._replace(acceleration=fall[None]), np.zeros(3)
    for _ in range(round(end / dt)):
        gas.step(still._replace(velocity=speed[None]), dt)
        speed = speed + dt * (gas.exchange.loads.force[0] / MASS + fall)
    exact = solve_ivp(
        lambda _, w: [pull - _deceleration(drag, w[0])], (0.0, end), [0.0], rtol=1e-10
    ).y[0, -1]
    assert -speed[2] == pytest.approx(exact, rel=5e-3)
    assert _deceleration(drag, -speed[2]) == pytest.approx(pull, rel=5e-3)


def _deceleration(drag, speed):
    reynolds, mach = DENSITY * speed * SIZE / VISCOSITY, speed / SOUND
    slip = VISCOSITY / (DENSITY * SOUND * SIZE)
    factor = laws.drag_factor(laws.DRAG[drag], reynolds, mach, slip, 1.0, GAMMA)
    return 3.0 * math.pi * VISCOSITY * SIZE * factor * speed / MASS


def test_dust_and_gas_relax_together_as_the_exact_solution_has_it():
    """Even dust, half as heavy as the gas: v - u decays by (1 + loading)/τ; the heat is an ODE."""
    gas, places = Gas(jitter=0.0), []
    grid = (np.arange(10) + 0.5) / 10
    places = [[x, 0.0, z] for x in grid for z in grid]
    number = 0.5 * DENSITY / 100.0 / MASS  # so that there is half a kilogram of dust to one of gas
    gas.primitive[:, 1] = 100.0
    particles = dust(places, temperature=500.0, number=number)
    end = RELAXES
    write_conservative(gas.primitive, GAMMA, gas.conservative)
    before = gas.content()
    v, warm = relax(gas, particles, end, RELAXES / 100.0)
    loading, heat = 0.5, 12.0 * TRANSPORT.conduction * VISCOSITY / (MATERIAL * SIZE**2)

    def rates(_, state):
        u, v, warm, cool = state
        drag = (u - v) / RELAXES
        heat_flow = heat * (cool - warm)
        return [
            -loading * drag,
            drag,
            heat_flow / WARMTH,
            loading * (drag * (u - v) - heat_flow) / CAPACITY,
        ]

    exact = solve_ivp(rates, (0.0, end), [100.0, 0.0, 500.0, 300.0], rtol=1e-10).y[:, -1]
    assert gas.primitive[:, 1] == pytest.approx(exact[0], rel=2e-3)
    assert v[:, 0] == pytest.approx(exact[1], rel=2e-3)
    assert warm == pytest.approx(exact[2], rel=2e-3)
    cool = gas.primitive[:, 4] / gas.primitive[:, 0] / GAS_CONSTANT
    assert cool == pytest.approx(exact[3], rel=2e-3)
    # Momentum and energy of both together.
    mass = number * MASS
    gained = mass * v.sum(axis=0)
    lost = before - gas.content()
    assert lost[1] == pytest.approx(gained[0], rel=1e-11)
    heated = (particles.heat_capacity * (warm - 500.0)).sum()
    kinetic = 0.5 * mass * (v**2).sum()
    assert lost[4] == pytest.approx(heated + kinetic, rel=2e-5)


@pytest.mark.parametrize(("planar", "nodes"), [(True, 4), (False, 8)])
def test_a_particle_in_the_middle_of_a_cell_feels_its_corners_alike(planar, nodes):
    gas = Gas(planar=planar, spacing=0.25, jitter=0.0, nodes=nodes)
    gas.step(dust([[0.5, 0.5, 0.5]], velocity=(30.0, 0.0, 0.0)), 1e-7)
    assert gas.exchange.weights == pytest.approx(1.0 / nodes)
    assert gas.exchange.loads.force[0, 0] < 0.0 and gas.exchange.stable_dt(gas.primitive) > 0.0


def test_the_step_follows_the_faster_of_particle_and_gas():
    """Explicit coupling: 1/τ of the particle, and of the nodes with all the dust around them."""
    gas = Gas(jitter=0.0)
    for number in (1.0, 1e9):
        gas.exchange.place(dust([0.55, 0.0, 0.55], number=number))
        gas.exchange.add(gas.primitive, None, 0.0, (0.0, 1.0, 1.0))
        weights = gas.exchange.weights[0]
        drag = 3.0 * math.pi * VISCOSITY * SIZE * number
        node = drag * weights.max() / (DENSITY * 0.01)
        heat = 2.0 * math.pi * TRANSPORT.conduction * VISCOSITY * SIZE * number
        node = max(node, heat * weights.max() / (DENSITY * 0.01 * CAPACITY))
        dt = gas.exchange.stable_dt(gas.primitive)
        particle = max(1.0 / RELAXES, heat / (number * MASS * WARMTH))
        assert dt == pytest.approx(0.5 / (particle + node), rel=1e-9)
    assert math.isinf(Gas().exchange.stable_dt(gas.primitive))
