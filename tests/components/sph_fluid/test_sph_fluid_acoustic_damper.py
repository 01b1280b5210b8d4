"""The damper of sound: its decay rate, no effect on shear, and its step limit."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from device_bodies import JOINED, MIRRORED, Cube, around
from fluid_params import fluid_params

from quintet.components.shared.smoothing.smoothing import KERNELS, STEEPEST, gradient, smoothing
from quintet.components.sph_fluid.component import SphFluid
from quintet.components.sph_fluid.pairs.acoustic_damper import courant_limit
from quintet.interfaces.component import Fields
from quintet.interfaces.errors import StepError

Make = Callable[..., SphFluid]
LENGTH, SOUND = 0.48, 20.0  # m, m/s
K = math.pi / LENGTH  # 1/m, of the longest wave between the ends
CALM = {
    "gravity": (0.0, 0.0, 0.0),
    "negative_pressure": True,
    "viscosity.artificial": 0.0,
    "kernel": "wendland",
}


def tube(spacing: float = 0.02, **changes: Any) -> SphFluid:
    """Make a closed slab of fluid between two planes of symmetry, floor and lid."""
    box = ((0.0, 0.0, 0.0), (LENGTH, 0.1, LENGTH))
    closed_tank = {
        "fluid": (box,),
        "boundary.walls": box,
        "boundary.open_faces": (),
        "boundary.symmetry": ("x-", "x+"),
        "dimensions": 2,
    }
    settings = {"spacing": spacing, "sound_speed": SOUND, "integration": "symplectic"}
    fluid = SphFluid(
        fluid_params(**(settings | closed_tank | {"boundary.method": "mdbc"} | CALM | changes))
    )
    fluid.state.position_density[:, 3] += 1.0  # kg/m3; walls cannot pull
    return fluid


def fading(fluid: SphFluid) -> float:
    """Rate [1/s] at which the longest standing wave fades, over two periods."""
    rows, time = slice(fluid.state.fluid), 2.0 * 2.0 * math.pi / (K * SOUND)
    fluid.state.velocity_pressure[rows, 0] = 1e-3 * np.sin(
        K * fluid.state.position_density[rows, 0]
    )
    count, amplitudes = math.ceil(time / fluid.stable_dt()), []
    for _ in range(count):
        fluid.step(time / count)
        phase, speed = (
            K * fluid.state.position_density[rows, 0],
            fluid.state.velocity_pressure[rows, 0],
        )
        acoustic_speed = (fluid.state.position_density[rows, 3] - 1001.0) * SOUND / 1000.0
        amplitudes.append([(speed * np.sin(phase)).mean(), (acoustic_speed * np.cos(phase)).mean()])
    energy = (np.array(amplitudes) ** 2).sum(axis=1)
    return -0.5 * float(np.polyfit(np.arange(count) * time / count, np.log(energy), 1)[0])


@pytest.mark.parametrize(("spacing", "error"), [(0.02, 0.09), (0.01, 0.06)])
# With diffusion the plain fluid is compiled for other tests too, and the damped one for one here.
@pytest.mark.parametrize("diffusion", [pytest.param(0.0, marks=pytest.mark.full), 0.1])
def test_sound_fades_as_bulk_viscosity_lets_it(
    spacing: float, error: float, diffusion: float
) -> None:
    """Pairs near the floor and the lid see less of ∇·u; the error grows with the spacing."""
    plain, damped = (
        fading(tube(spacing, density_diffusion=diffusion, acoustic_damper=z)) for z in (0.0, 0.5)
    )
    expected = 0.5 * 0.5 * 1.5 * spacing * SOUND * K**2
    assert damped - plain == pytest.approx(expected, rel=error)


def damper_input(fluid: SphFluid) -> np.ndarray:
    """Rate of compression that the damper uses: -ρ∇·u (n,) kg/(m3 s)."""
    fluid.lists.sort(fluid.state)
    fluid._list()
    fluid._compute_rates(0.0, 0.0)
    return fluid.state.minus_rho_div_u[: fluid.state.fluid]


def test_damper_leaves_shear_alone() -> None:
    fluid = tube(acoustic_damper=1.0)
    place, motion = fluid.state.position_density, fluid.state.velocity_pressure
    inside = (np.abs(place[: fluid.state.fluid, [0, 2]] - 0.24) < 0.12).all(axis=1)
    motion[:, 0] = np.sin(20.0 * place[:, 2])
    assert np.abs(damper_input(fluid)[inside]).max() < 1e-9  # ∂u/∂z would give 2e4


def test_damper_knows_the_flow_without_what_diffuses() -> None:
    fluid = tube(acoustic_damper=1.0, density_diffusion=0.1)
    fluid.state.position_density[:, 3] += np.random.default_rng(1).normal(
        0.0, 1.0, len(fluid.state.position_density)
    )
    assert not damper_input(fluid).any()
    assert np.abs(fluid.pairs.rates.rate[: fluid.state.fluid, 3]).min() > 0.0


def steepest_of(kernel: Any, dimensions: int, length: float) -> float:
    """Greatest h |Σ V sin(k·r) ∇W| (1) on a lattice; h [1] in spacings."""
    axes = [np.arange(-4.0, 5.0)] * dimensions
    offsets = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, dimensions)
    offsets = offsets[offsets.any(axis=1)]
    choice = smoothing(kernel, dimensions, length)
    squares = (offsets**2).sum(axis=1)
    is_near = squares < (2.0 * length) ** 2
    slopes = [gradient.py_func(r2, r2**-0.5, choice) for r2 in squares[is_near]]
    slopes = np.array(slopes)[:, np.newaxis] * offsets[is_near]
    largest = 0.0
    for direction in ([1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0]):
        unit = np.array(direction[:dimensions]) / np.linalg.norm(direction[:dimensions])
        phases = np.linspace(0.1, math.pi, 60)[:, np.newaxis] * (offsets[is_near] @ unit)
        largest = max(largest, np.linalg.norm(np.sin(phases) @ slopes, axis=1).max())
    return length * float(largest)


@pytest.mark.parametrize("kernel", KERNELS)
def test_the_steepest_wave_is_that_of_lattices(kernel: Any) -> None:
    lengths = (1.2, 1.35, 1.5, 1.75, 2.0)
    values = [steepest_of(kernel, d, length) for d in (2, 3) for length in lengths]
    assert STEEPEST[kernel] - 0.015 < max(values) < STEEPEST[kernel]


@pytest.mark.parametrize(("share", "calm"), [(0.97, True), (1.06, False)])
@pytest.mark.parametrize(
    ("kernel", "steepest", "size"),
    [
        ("wendland", 1.127, 0.3),
        ("wendland", 1.127, 1.0),
        ("wendland", 1.127, 2.0),
        pytest.param("quintic", 1.299, 1.0, marks=pytest.mark.full),
    ],
)
def test_step_limit_is_where_the_steepest_sound_grows(
    kernel: Any, steepest: float, size: float, share: float, calm: bool
) -> None:
    assert steepest == pytest.approx(steepest_of(kernel, 2, 1.5), abs=2e-3)
    exact = math.sqrt(size**2 + (2.0 / steepest) ** 2) - size
    fluid = tube(acoustic_damper=size, courant=4.0, kernel=kernel)
    assert fluid.stable_dt() == pytest.approx(courant_limit(size, kernel) * 0.03 / SOUND, rel=1e-3)
    assert courant_limit(size, kernel) < exact
    noise = np.random.default_rng(1).normal(0.0, 1e-6, (fluid.state.fluid, 2))
    fluid.state.velocity_pressure[: fluid.state.fluid, [0, 2]] = noise
    before = fluid.totals().kinetic
    try:
        for _ in range(300):
            fluid.step(share * exact * 0.03 / SOUND)
    except StepError:
        assert not calm
    else:
        assert (fluid.totals().kinetic < before) is calm


@pytest.mark.parametrize("boundary", [pytest.param("dbc", marks=pytest.mark.full), "mdbc"])
def test_surface_takes_what_the_fluid_gives(
    drop: Make, plate: Any, struck: Any, boundary: str
) -> None:
    settings = CALM | {
        "acoustic_damper": 1.0,
        "boundary.method": boundary,
        "integration": "symplectic",
    }
    fluid = drop(**settings)
    fields: Fields = plate(fluid)
    mirror = fields["surface.position"] + [0.0, 0.0, 0.02]
    impulse, gained = struck(fluid, fields | {"surface.mirror": mirror})
    assert np.abs(impulse[:, 2]).sum() > 0.0
    assert impulse.sum(axis=0) == pytest.approx(-gained, abs=1e-12 * np.abs(impulse).sum())


def test_the_damper_changes_no_stiffness_of_the_contact_potential() -> None:
    fluid, cube = (
        SphFluid(around(**MIRRORED, acoustic_damper=0.5, integration="symplectic")),
        Cube(),
    )
    contact = {"surface.contact": np.ones(len(cube.arm))}
    fluid.bind(cube.static | contact, JOINED)
    fluid.take(cube.fields())
    before = fluid.state.velocity_pressure[fluid.samples.row, 3]
    for _ in range(3):
        fluid.step(1e-4)
    after = fluid.state.velocity_pressure[fluid.samples.row, 3]
    assert before.min() > 0.0
    assert np.array_equal(after, before)
