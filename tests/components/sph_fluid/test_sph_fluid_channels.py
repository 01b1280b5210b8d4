"""Viscous flow between two walls, from rest: Morris, Fox & Zhu, J. Comput. Phys. 136 (1997) 214.

A slab six channels long, open at both ends, stands for an endless one: no pressure drives it, and
in half a channel's time of viscosity its ends are felt two channels away. Lengths are those of
the channel's height, times those of height²/ν; the Reynolds number is 0.2.
"""

from typing import Any

import numpy as np
import pytest
from fluid_params import nested

from quintet.components.sph_fluid import SphFluidParams
from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.params import read

LENGTH, SPEED, SPACING = 6.0, 0.2, 0.05
TIMES = (0.05, 0.1, 0.2, 0.4)
TABLE: dict[str, Any] = {
    "spacing": SPACING,
    "dimensions": 2,
    "sound_speed": 40.0 * SPEED,
    "fluid": [[[0.0, 0.0, 0.0], [LENGTH, 1.0, 1.0]]],
    "boundary.walls": [[-1.0, 0.0, 0.0], [LENGTH + 1.0, 1.0, 1.0]],
    "boundary.open_faces": ["x-", "x+"],
    "gravity": [0.0, 0.0, 0.0],
    "boundary.method": "mdbc",
    "negative_pressure": True,
    "density_diffusion": 0.1,
    "viscosity.artificial": 0.0,
    "viscosity.kinematic": 1.0,
}


def channel(**changes: Any) -> SphFluid:
    params, mistakes = read(SphFluidParams, nested(TABLE | changes), "water")
    assert not mistakes
    return SphFluid(params)


def poiseuille(z: np.ndarray, t: float) -> np.ndarray:
    """Morris, Fox & Zhu, eq. (31), of a flow that comes to SPEED."""
    k = (2 * np.arange(60)[:, None] + 1) * np.pi
    transient = (32.0 / k**3 * np.sin(k * z) * np.exp(-(k**2) * t)).sum(axis=0)
    return SPEED * (4.0 * z * (1.0 - z) - transient)


def couette(z: np.ndarray, t: float) -> np.ndarray:
    """Morris, Fox & Zhu, eq. (29)."""
    k = np.arange(1, 200)[:, None] * np.pi
    return SPEED * (z + (2.0 / k * np.cos(k) * np.sin(k * z) * np.exp(-(k**2) * t)).sum(axis=0))


@pytest.mark.parametrize(
    ("changes", "exact"),
    [
        ({"gravity": [8.0 * SPEED, 0.0, 0.0]}, poiseuille),
        ({"boundary.wall_velocity": {"z+": [SPEED, 0.0, 0.0]}}, couette),
    ],
)
def test_flow_starts_as_the_series_says(changes: dict[str, Any], exact: Any) -> None:
    fluid, elapsed, errors = channel(**changes), 0.0, []
    for time in TIMES:
        while elapsed < time - 1e-12:
            dt = min(fluid.stable_dt(), time - elapsed)
            fluid.step(dt)
            elapsed += dt
        view = fluid.view()
        middle = np.abs(view["points"][:, 0] - 0.5 * LENGTH) < 0.5
        expected = exact(view["points"][middle, 2], elapsed)
        errors.append(np.abs(view["velocity"][middle, 0] - expected).max() / expected.max())
    assert max(errors) < 0.02, errors


def test_fluid_that_nothing_bears_has_no_weight() -> None:
    """It falls along an open axis, and starts without a pressure that would burst it."""
    fluid = channel(gravity=[1.6, 0.0, -1.6], sound_speed=40.0)
    assert fluid.params.hydrostatic_gravity == (0.0, 0.0, -1.6)
    assert fluid.params.depth == 1.0
    pressure, below = fluid.view()["pressure"], 1.0 - fluid.view()["points"][:, 2]
    assert pressure == pytest.approx(1600.0 * below, rel=1e-3)


@pytest.mark.parametrize(
    ("face", "velocity"),
    [("x+", [0.0, 0.0, 1.0]), ("y-", [1.0, 0.0, 0.0])],
)
def test_only_closed_faces_move(face: str, velocity: list[float]) -> None:
    params, mistakes = read(
        SphFluidParams, nested(TABLE | {"boundary.wall_velocity": {face: velocity}}), "water"
    )
    assert params is None
    assert f"wall_velocity.{face} must be of a closed face of the tank, z-, z+; " in mistakes[0]


def test_a_wall_does_not_move_across_its_plane() -> None:
    table = TABLE | {"boundary.wall_velocity": {"z+": [0.0, 0.0, 1.0]}}
    (mistake,) = read(SphFluidParams, nested(table), "water")[1]
    assert "wall_velocity.z+ must lie in the plane of the face; found (0.0, 0.0, 1.0)" in mistake


def test_without_walls_no_wall_moves() -> None:
    table = {
        "spacing": 0.1, "sound_speed": 30.0, "fluid": [{"lowest": [0.0] * 3, "highest": [0.3] * 3}],
        "boundary": {"wall_velocity": {"x+": [0.0, 1.0, 0.0]}},
    }  # fmt: skip
    (mistake,) = read(SphFluidParams, table, "water")[1]
    assert "x+ must be of a closed face of the tank, but the tank has none; found x+" in mistake
