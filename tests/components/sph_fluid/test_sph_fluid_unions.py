"""Unions of spheres and agglomerates are pushed up by the weight of the displaced water."""

import numpy as np
import pytest
import trimesh
from fluid_params import fluid_params

from quintet.components.dem_bodies.component import DemBodies
from quintet.components.dem_bodies.params import DemBodiesParams
from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.component import outputs_of
from quintet.interfaces.params import read

SPACING, CELLS = 0.03, 14  # m; along each edge of the tank
RADIUS, HALF = 3.5 * SPACING, 1.75 * SPACING  # m; of the spheres, and half of their distance
SIDE = CELLS * SPACING
SPEED = 22.0  # m/s
MATERIAL = {"youngs_modulus": 1e9, "poissons_ratio": 0.3, "restitution": 0.5, "friction": 0.4}


def body_of(shape, folder):
    """A union of two spheres, or a capsule from a file."""
    if shape == "spheres":
        return {"centres": [[-HALF, 0.0, 0.0], [HALF, 0.0, 0.0]], "radii": [RADIUS, RADIUS]}
    capsule = trimesh.creation.capsule(height=2.0 * HALF, radius=RADIUS, count=[16, 16])
    capsule.export(folder / "capsule.stl")
    spheres = {"dim": 8, "sphere_radius": 0.08}
    return {"file": str(folder / "capsule.stl"), "agglomerate": spheres}


def push(body, folder, begin, end):
    """Mean force from one time [s] to another on a body in water, over the weight it displaces."""
    table = {
        "materials": {"wood": MATERIAL},
        "bodies": [{"density": 1.0, "material": "wood", **body}],
    }
    params, mistakes = read(DemBodiesParams, table, "bodies", folder)
    assert not mistakes
    bodies = DemBodies(params)
    fluid = SphFluid(
        fluid_params(
            spacing=SPACING,
            sound_speed=SPEED,
            fluid=(((0.0, 0.0, 0.0), (SIDE, SIDE, SIDE)),),
            remove_inside_bodies=True,
            boundary__walls=((0.0, 0.0, 0.0), (SIDE, SIDE, SIDE + 0.12)),
            boundary__method="mdbc",
            density_diffusion=0.1,
            negative_pressure=True,
        )
    )
    request = {key.replace("surface", "motion"): x for key, x in fluid.describe().items()}
    options = {"motion.mirror": np.ones(1), "motion.dimensions": np.full(1, 3.0)}
    samples = bodies.sample(request | options)
    static = {f"surface.{key}": samples[f"motion.{key}"] for key in ("normal", "volume", "body")}
    fluid.bind(static, frozenset({"surface"}))
    fields = {
        "surface.position": samples["motion.arm"] + 0.5 * SIDE,
        "surface.mirror": samples["motion.image"] + 0.5 * SIDE,
        "surface.velocity": np.zeros_like(samples["motion.arm"]),
    }
    fluid.prime(fields)
    fluid.take(fields)
    time, duration, impulse = 0.0, 0.0, np.zeros(3)
    while time < end:
        dt = fluid.stable_dt()
        fluid.step(dt)
        time += dt
        if time > begin:
            duration += dt
            impulse += dt * outputs_of(fluid)["surface_load.force"].sum(axis=0)
    weight = 9810.0 * float(bodies.describe()["motion.mass"][0])  # of 1 kg/m3: the volume
    return impulse / duration / weight


@pytest.mark.parametrize("shape", ["spheres", "mesh"])
def test_a_body_in_water_is_pushed_up_by_the_weight_of_what_it_displaces(shape, tmp_path):
    body = {"shape": shape, **body_of(shape, tmp_path)}
    across, along, up = push(body, tmp_path, begin=0.2, end=0.5)
    assert up == pytest.approx(1.0, abs=0.02)
    # Gaps around these bodies have no symmetry, nor has the water that filled them.
    assert max(abs(across), abs(along)) < 0.01


def test_a_body_is_not_pushed_aside_where_samples_and_removed_water_are_symmetric(tmp_path):
    radius, half = 3.7 * SPACING, SPACING
    body = {"centres": [[-half, 0.0, 0.0], [half, 0.0, 0.0]], "radii": [radius, radius]}
    across, along, up = push({"shape": "spheres", **body}, tmp_path, begin=0.01, end=0.05)
    assert up > 0.5
    assert max(abs(across), abs(along)) < 1e-10


@pytest.mark.parametrize("shape", ["spheres", "mesh"])
@pytest.mark.parametrize("across", [6.0, 8.3])
def test_samples_of_a_body_are_as_many_as_cubes_of_the_spacing_that_it_holds(
    shape, across, tmp_path
):
    body = {"shape": shape, "density": 1.0, "material": "wood", **body_of(shape, tmp_path)}
    table = {"materials": {"wood": MATERIAL}, "bodies": [body]}
    bodies = DemBodies(read(DemBodiesParams, table, "bodies", tmp_path)[0])
    spacing = 2.0 * RADIUS / across
    request = {"spacing": spacing, "depth": 1.0, "inset": 0.5 * spacing, "mirror": 1.0}
    fields = {f"motion.{key}": np.full(1, x) for key, x in (request | {"dimensions": 3.0}).items()}
    volume = float(bodies.describe()["motion.mass"][0])
    samples = bodies.sample(fields)["motion.volume"]
    assert len(samples) == round(volume / spacing**3)
    assert samples.sum() == pytest.approx(volume, rel=1e-9)
