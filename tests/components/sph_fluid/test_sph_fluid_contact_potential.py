"""The contact potential: opposite forces, and the clearance that a pressure leaves."""

import math
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from fluid_params import fluid_params, nested, pair_sums

from quintet.components.shared.search.neighbours import Lists
from quintet.components.sph_fluid.boundary.contact_potential import (
    SAFE,
    contact_potential,
    fluid_share,
    lattice_pressure,
    pressure_at_rest,
    step_limit,
    stiffness,
    wall_force,
)
from quintet.components.sph_fluid.component import SphFluid
from quintet.components.sph_fluid.constants import pair_law
from quintet.components.sph_fluid.laws import PairLaw
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.ports import CONTACT
from quintet.interfaces.component import Fields, outputs_of
from quintet.interfaces.errors import PortError
from quintet.interfaces.params import read

Make = Callable[..., SphFluid]
Join = Callable[..., Fields]
Strike = Callable[..., tuple[Any, Any]]
JOINED = frozenset({"surface", "surface_load"})
SPACING = 0.02  # m, of the fixtures too
EDGE = 8 * SPACING


def run(fluid: SphFluid, time: float) -> None:
    """Step for a time [s] or a little more."""
    while time > 0.0:
        dt = fluid.stable_dt()
        fluid.step(dt)
        time -= dt


def params(**changes: Any) -> SphFluidParams:
    box = ((0.0, 0.0, 0.0), (EDGE, EDGE, EDGE))
    settings = {"spacing": SPACING, "sound_speed": 20.0 * math.sqrt(9.81 * EDGE), "fluid": (box,)}
    return fluid_params(**({"boundary.method": "potential"} | settings | changes))


# σ/(K Δp³) between two facing cubic lattices, summed independently of this code.
@pytest.mark.parametrize(
    ("smoothing", "exponent", "pressures"),
    [
        (1.5, 1, (14.2, 9.64, 4.77, 1.66, 0.263)),
        (1.5, 2, (11.5, 6.71, 1.93, 0.224, 4.4e-3)),
        (1.5, 4, (20.1, 6.62, 0.425, 4.5e-3, 1.9e-6)),
        (1.5, 6, (54.6, 7.93, 0.107, 1.0e-4, 7.7e-10)),
        (2.09, 4, (11.9, 6.85, 2.08, 0.274, 0.015)),
    ],
)
def test_pressure_between_lattices_is_the_tabled_one(
    smoothing: float, exponent: int, pressures: tuple[float, ...]
) -> None:
    parameters = params(smoothing=smoothing, boundary__potential_exponent=exponent)
    computed = [lattice_pressure(distance, parameters) for distance in (0.5, 1.0, 1.5, 2.0, 2.5)]
    assert computed == pytest.approx(pressures, rel=0.05)  # its digits


@pytest.mark.parametrize(
    ("kernel", "exponent"),
    [
        *(("cubic", n) for n in range(1, 9)),
        ("wendland", 4),
        pytest.param("quintic", 4, marks=pytest.mark.full),
    ],
)
def test_force_on_a_plate_is_that_of_the_lattices(
    drop: Make, plate: Join, kernel: str, exponent: int
) -> None:
    settings = {
        "kernel": kernel,
        "boundary.potential_exponent": exponent,
        "gravity": (0.0, 0.0, 0.0),
    }
    # Diffuses nothing in a lattice; with Wendland's kernel it is compiled for other tests too.
    diffusion = {"density_diffusion": 0.1} if kernel == "wendland" else {}
    fluid = drop(
        boundary__method="potential", boundary__potential_stiffness=3e3, **settings, **diffusion
    )
    fluid.state.position_density[:216, :3] += SPACING * np.array(
        [0.5, 0.5, -0.5]
    )  # above samples, from z = 0
    fluid.take(plate(fluid, height=-1.3 * SPACING, speed=0.0))
    fluid.step(1e-9)
    force = outputs_of(fluid)["surface_load.force"].reshape(7, 7, 3)[3, 3]
    # One layer of samples pushes less than a thick wall, by the push of the layers below it.
    expected = 3e3 * (lattice_pressure(1.3, fluid.params) - lattice_pressure(2.3, fluid.params))
    assert force[2] / SPACING**2 == pytest.approx(-expected, rel=1e-6)


@pytest.mark.parametrize("kinematic", [0.0, pytest.param(1e-3, marks=pytest.mark.full)])
def test_contact_gives_and_takes_the_same_impulse(
    drop: Make, plate: Join, struck: Strike, kinematic: float
) -> None:
    settings = {
        "gravity": (0.0, 0.0, 0.0),
        "viscosity.kinematic": kinematic,
        "boundary.potential_stiffness": 3e3,
    }
    fluid = drop(boundary__method="potential", **settings)
    impulse, gained = struck(fluid, plate(fluid))
    assert np.abs(impulse[:, 2]).sum() > 0.0
    assert impulse.sum(axis=0) == pytest.approx(-gained, abs=1e-12 * np.abs(impulse).sum())


@pytest.mark.parametrize("exponent", [1, 4])
def test_energy_is_the_work_of_the_plate(drop: Make, plate: Join, exponent: int) -> None:
    settings = {
        "boundary.potential_exponent": exponent,
        "boundary.potential_stiffness": 2e3,
        "viscosity.artificial": 0.0,
    }
    fluid = drop(boundary__method="potential", gravity=(0.0, 0.0, 0.0), courant=0.02, **settings)
    fields = {name: np.array(array) for name, array in plate(fluid, height=-SPACING).items()}
    work, energies = 0.0, []
    for _ in range(400):
        fluid.take(fields)
        dt = fluid.stable_dt()
        fluid.step(dt)
        work -= dt * float(
            (outputs_of(fluid)["surface_load.force"] * fields["surface.velocity"]).sum()
        )
        fields["surface.position"] += dt * fields["surface.velocity"]
        totals = fluid.totals()
        energies.append(totals.kinetic + totals.internal - work)
    assert work > 0.05
    assert np.ptp(energies) < 0.02 * work


@pytest.mark.parametrize("exponent", [1, 4])
def test_water_settles_at_one_spacing_where_its_weight_is_lattice_pressure(exponent: int) -> None:
    width, depth = 40 * SPACING, 10 * SPACING
    tank = {
        "dimensions": 2,
        "fluid": (((0.0, 0.0, 0.0), (width, SPACING, depth)),),
        "boundary.walls": ((0.0, 0.0, 0.0), (width, SPACING, 2.0 * depth)),
        "sound_speed": 20.0 * math.sqrt(9.81 * depth),
        "boundary.potential_exponent": exponent,
    }
    stiff = float(stiffness(np.array([1000.0 * 9.81 * depth]), params(**tank))[0])
    terms = {
        "boundary.potential_stiffness": stiff,
        "boundary.wall_viscosity_factor": 0.0,
        "viscosity.artificial": 1.0,
        "negative_pressure": True,
    }
    fluid = SphFluid(params(**tank, **terms))
    run(fluid, 0.8)
    lowest = np.sort(fluid.view()["points"][:, 2])[:40]
    assert lowest.mean() / SPACING + 0.5 == pytest.approx(1.0, rel=0.03)


def test_walls_and_bodies_hold_the_pressure_of_water_at_rest(pool: Make, plate: Join) -> None:
    fluid = pool(boundary__method="potential")
    walls = fluid.state.position_density[fluid.state.fluid :]
    fluid.take(plate(fluid, height=0.03, speed=0.0))
    depth = 0.1 - np.concatenate([walls[:, 2], np.full(49, 0.03)])
    pressures = 1000.0 * 9.81 * np.maximum(depth, 0.0)
    assert pressure_at_rest(walls[:, :3], fluid.params) == pytest.approx(pressures[:-49])
    expected = stiffness(pressures, fluid.params) / 1e6
    assert fluid.state.velocity_pressure[fluid.state.fluid :, 3] == pytest.approx(expected)
    potential_pressures = stiffness(pressures, fluid.params) * lattice_pressure(1.0, fluid.params)
    assert potential_pressures + pressures * fluid_share(1.0, fluid.params) == pytest.approx(
        pressures
    )


def test_bodies_that_are_dry_hold_the_mean_pressure(pool: Make, plate: Join) -> None:
    fluid = pool(boundary__method="potential")
    fluid.take(plate(fluid, height=0.13))
    expected = stiffness(np.array([490.5]), fluid.params)[0] / 1e6
    assert fluid.state.velocity_pressure[fluid.samples.row, 3] == pytest.approx(
        np.full(49, expected)
    )


def wander(step: float) -> float:
    """Largest displacement, in spacings, of a particle held where the potential is steepest.

    The step is in units of √(m/k); the particle starts 1e-3 spacings off.
    """
    law = params(gravity=(0.0, 0.0, 0.0), viscosity__artificial=0.0, boundary__potential_exponent=4)
    stiff = 3e3  # Pa
    distances = np.linspace(0.3, 2.0, 171)
    push = np.array([wall_force(distance, law) for distance in distances])
    steepest = int(np.gradient(push, distances).argmin())
    pull = stiff * push[steepest] / (1000.0 * SPACING)  # m/s2
    wall = np.arange(-4, 5) * SPACING
    z, y, x = (grid.ravel() for grid in np.meshgrid(SPACING * np.arange(-2, 1), wall, wall))
    start = distances[steepest] * SPACING
    particle = np.array([0.0, 0.0, start + 1e-3 * SPACING, 1000.0])
    place = np.vstack([particle, np.column_stack([x, y, z, np.full(x.size, 1000.0)])])
    motion, dt = np.zeros_like(place), step * step_limit(stiff, law) / SAFE
    motion[1:, 3] = stiff / 1000.0**2
    begin, middle, end = np.array([0]), np.array([1]), np.array([len(place)])
    lists = Lists(begin, middle, end, np.arange(len(place), dtype=np.int32))
    # The boundary's only term is the potential.
    numbers = pair_law(law, contact_potential(law))
    no_repulsion = numbers.boundary.repulsion._replace(stiffness=0.0)
    potential_law: PairLaw = numbers._replace(
        boundary=numbers.boundary._replace(repulsion=no_repulsion)
    )
    furthest = 0.0
    for _ in range(25):  # before it slides off the ridge that it stands on
        rate = pair_sums(potential_law, place, motion, lists, 1, (0.0, 0.0, -pull))
        motion[0, :3] += dt * rate[0, :3]
        place[0, :3] += dt * motion[0, :3]
        furthest = max(furthest, abs(place[0, 2] - start) / SPACING)
    return furthest


def test_step_limit_is_a_tenth_of_where_rest_becomes_unstable() -> None:
    assert SAFE == 0.1 * 2.0
    assert wander(1.9) < 0.01
    assert wander(2.1) > 0.1


def test_a_stiffness_without_the_potential_is_a_mistake() -> None:
    settings = {"spacing": 0.1, "sound_speed": 60.0, "fluid": [[[0, 0, 0], [1, 1, 1]]]}
    settings |= {"boundary.method": "dbc", "boundary.potential_stiffness": 1e3}
    mistakes = read(SphFluidParams, nested(settings), "water")[1]
    sentence = (
        r"potential_stiffness belongs to boundary.method potential, or .* found dbc. Remove it, or"
    )
    assert re.search(sentence, "\n".join(mistakes))


def test_films_leave_a_link_no_choice() -> None:
    box = ((0.0, 0.0, 0.0), (EDGE, EDGE, EDGE))
    for films in (False, True):
        port = SphFluid(
            params(boundary__method="mdbc", boundary__lubrication_films=films, fluid=(box,))
        ).takes[0]
        assert (CONTACT in port.static) is not films


def test_the_contact_of_some_samples_alone_is_refused() -> None:
    box = ((0.0, 0.0, 0.0), (EDGE, EDGE, EDGE))
    fluid = SphFluid(params(boundary__method="mdbc", fluid=(box,)))
    static = {"volume": np.full(2, SPACING**3), "body": np.zeros(2), "contact": np.ones(1)}
    sentence = "contact must be said of all 2 samples or of none; found 1. Let every link"
    with pytest.raises(PortError, match=sentence):
        fluid.bind({f"surface.{key}": array for key, array in static.items()}, JOINED)
