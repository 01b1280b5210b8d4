"""Unions of spheres in water are pushed up by the weight of the water that they displace."""

from itertools import product

import numpy as np
import pytest
from fluid_params import fluid_params

from quintet.components.dem_bodies.shapes.sphere_union import measure_union
from quintet.components.shared.geometry.surface_samples import Sampling, spheres
from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.component import outputs_of

SPACING, CELLS = 0.03, 12  # m; along each edge of the tank
CENTRES = ((-1.5 * SPACING, 0.0, 0.0), (1.5 * SPACING, 0.0, 0.0))
RADII = (3.0 * SPACING, 3.0 * SPACING)
SPEED, BEGIN, END = 20.0, 0.3, 0.45  # m/s; s


def columns() -> tuple:
    """Boxes of water around the union in the middle of the tank."""
    place = SPACING * (np.arange(CELLS) + 0.5 - 0.5 * CELLS)
    found = []
    for i, j in product(range(CELLS), repeat=2):
        points = np.stack([np.full(CELLS, place[i]), np.full(CELLS, place[j]), place], axis=1)
        away = np.linalg.norm(points[:, None] - np.array(CENTRES), axis=2)
        wet = np.concatenate([[False], (away > RADII).all(axis=1), [False]])
        starts, ends = (np.flatnonzero(np.diff(wet.astype(int)) == sign) for sign in (1, -1))
        for low, high in zip(starts.tolist(), ends.tolist(), strict=True):
            corners = (i, j, low), (i + 1, j + 1, high)
            found.append(tuple(tuple(SPACING * x for x in corner) for corner in corners))
    return tuple(found)


def test_a_union_of_spheres_is_pushed_up_by_the_weight_of_its_water():
    side = CELLS * SPACING
    settings = {
        "spacing": SPACING,
        "sound_speed": SPEED,
        "fluid": columns(),
        "boundary.walls": ((0.0, 0.0, 0.0), (side, side, side + 0.09)),
        "boundary.method": "mdbc",
        "density_diffusion": 0.1,
        "negative_pressure": True,
    }
    fluid = SphFluid(fluid_params(**settings))
    stated = fluid.describe()
    depth, inset = (float(stated[f"surface.{key}"][0]) for key in ("depth", "inset"))
    volume = measure_union((CENTRES, RADII))[0]
    asked = Sampling(SPACING, depth, inset, mirrored=True)
    body = spheres(np.array(CENTRES), np.array(RADII), volume, asked)
    static = {"surface.normal": body.normal, "surface.volume": body.volume}
    fluid.bind(static | {"surface.body": np.zeros(len(body.arm))}, frozenset({"surface"}))
    placed = {"surface.position": body.arm, "surface.mirror": body.image}
    middle = {key: points + 0.5 * side for key, points in placed.items()}
    fluid.take(middle | {"surface.velocity": np.zeros_like(body.arm)})
    time, spent, impulse = 0.0, 0.0, np.zeros(3)
    while time < END:
        dt = fluid.stable_dt()
        fluid.step(dt)
        time += dt
        if time > BEGIN:
            spent += dt
            impulse += dt * outputs_of(fluid)["surface_load.force"].sum(axis=0)
    push = impulse / spent / (9810.0 * volume)
    assert push[2] == pytest.approx(1.0, abs=0.02)
    assert np.abs(push[:2]).max() < 1e-3
