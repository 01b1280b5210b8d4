"""A rod that strikes a plate of another solver moves as in one solver of either kind."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from quintet.components.fe_plate.component import FePlate
from quintet.components.fe_plate.meshes.params import Part
from quintet.components.fe_plate.meshes.selections import Elements, Fixed
from quintet.components.fe_plate.params import FePlateParams, Gauges
from quintet.components.shared.materials.params import Material
from quintet.components.sph_solid.component import SphSolid
from quintet.components.sph_solid.params import Body, SphSolidParams, SymmetryPlane
from quintet.coupler.files.recording import Recording

Run = Callable[..., dict]
Curve = tuple[NDArray[np.float64], NDArray[np.float64]]  # s since the touch, m/s

SPEED, GAP, LONG, LAYERS = 10.0, 1e-5, 0.1, 100  # m/s, m, m, elements in 100 mm
CLOSED = GAP / SPEED  # s
TOUCHING = np.linspace(3e-6, 31e-6, 57)  # s after the touch; they part after 2 L/c = 32.7 us
ALUMINIUM = Material(density=2780.0, youngs_modulus=7.0e10, poissons_ratio=0.33)
CALM = {"viscosity_linear": 0.0, "viscosity_quadratic": 0.0}


@pytest.fixture(scope="module")
def coupled(run_scene: Run) -> Curve:
    """Mean velocity of the rod in the scene."""
    results = run_scene("rod_on_plate", "--transport", "memory", "--set", "output.totals=0")
    with Recording(results["folder"]) as recording:
        velocity = recording.history("rod", "bodies.velocity", 0)[:, 2]
        return recording.times("rod") - CLOSED, velocity


def _in_elements(folder: Path) -> Curve:
    """Rod and plate as one column of elements, whose upper half moves at the start."""
    size, nodes, solids, velocities = LONG / LAYERS, "", "", ""
    for level in range(2 * LAYERS + 1):
        z = (level - LAYERS) * size
        speed = -SPEED if level > LAYERS else -0.5 * SPEED if level == LAYERS else 0.0
        for k, (x, y) in enumerate(((0.0, 0.0), (size, 0.0), (size, size), (0.0, size))):
            nodes += f"{4 * level + k + 1},{x!r},{y!r},{z!r}\n"
            velocities += f"{4 * level + k + 1},0.0,0.0,{speed!r}\n" if speed else ""
        if level < 2 * LAYERS:
            corners = (4 * level + k + 1 for k in range(8))
            solids += f"{level + 1},1,{','.join(map(str, corners))}\n"
    text = f"*KEYWORD\n*NODE\n{nodes}*ELEMENT_SOLID\n{solids}*INITIAL_VELOCITY_NODE\n{velocities}"
    (folder / "column.k").write_text(text)
    part = Part(shape="mesh", file=str(folder / "column.k"), scale=1.0, material=ALUMINIUM)
    low, high = (-size, -size, -size), (2.0 * size, 2.0 * size, 2.0 * LONG)
    side_support = Fixed(lowest=(-size, -size, -2.0 * LONG), highest=high, directions=("x", "y"))
    rod = Elements(lowest=(*low[:2], -0.1 * size), highest=high)
    column = FePlate(
        FePlateParams(
            parts=(part,), fixed=(side_support,), integration="reduced", **CALM,
            gauges=Gauges(element_set_gauges=(rod,)),
        )
    )  # fmt: skip
    key, times, velocity = "element_set_gauge.velocity", [0.0], [-SPEED]
    while times[-1] < TOUCHING[-1]:
        dt = column.stable_dt()
        column.step(dt)
        times.append(times[-1] + dt)
        velocity.append(column.give(frozenset((key,)))[key][0, 2])
    return np.array(times), np.array(velocity)


def _in_particles(_: Path) -> Curve:
    """Rod and plate as two bodies of particles, which touch each other."""
    wide, key = 3e-3, "bodies.velocity"
    rod = Body(
        lowest=(0.0, 0.0, GAP), highest=(wide, 1.0, LONG + GAP), velocity=(0.0, 0.0, -SPEED),
        material=ALUMINIUM,
    )  # fmt: skip
    plate = Body(lowest=(0.0, 0.0, -LONG), highest=(wide, 1.0, 0.0), material=ALUMINIUM)
    sides = (
        SymmetryPlane(axis="x", position=0.0, side="+"),
        SymmetryPlane(axis="x", position=wide, side="-"),
    )
    column = SphSolid(
        SphSolidParams(spacing=LONG / LAYERS, dimensions=2, bodies=(rod, plate), symmetry=sides)
    )
    times, velocity = [0.0], [-SPEED]
    while times[-1] - CLOSED < TOUCHING[-1]:
        dt = column.stable_dt()
        column.step(dt)
        times.append(times[-1] + dt)
        velocity.append(column.give(frozenset((key,)))[key][0, 2])
    return np.array(times) - CLOSED, np.array(velocity)


@pytest.mark.parametrize("single_solver", [_in_elements, _in_particles])
def test_a_rod_moves_as_in_one_solver_until_it_parts(
    coupled: Curve, tmp_path: Path, single_solver: Callable[[Path], Curve]
) -> None:
    coupled_speed, single_speed = (
        np.interp(TOUCHING, *curve) for curve in (coupled, single_solver(tmp_path))
    )
    # The springs of contact give way as one layer of each side, in Δ/c = 0.16 us of 16.4 us.
    assert np.abs(coupled_speed - single_speed).max() < 0.01 * SPEED
    # Forces on the rod, over its mass.
    forces = [np.polyfit(TOUCHING, curve, 1)[0] for curve in (coupled_speed, single_speed)]
    assert forces[0] == pytest.approx(forces[1], rel=0.005)
