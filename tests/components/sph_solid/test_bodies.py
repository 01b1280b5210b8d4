"""Shapes, initial motion and gravity of bodies, against exact solutions."""

import math

import numpy as np
import pytest

from quintet.components.shared.materials.params import Material
from quintet.components.sph_solid.body import Body
from quintet.components.sph_solid.component import SphSolid
from quintet.components.sph_solid.params import Fixed, Region, SphSolidParams, SymmetryPlane
from quintet.components.sph_solid.plan import expected_count
from quintet.interfaces.errors import SceneError

DX = 1e-3  # m
E, NU, RHO = 1e7, 0.3, 1000.0
RUBBER = Material(density=RHO, youngs_modulus=E, poissons_ratio=NU)
BALL = {"shape": "sphere", "centre": (0.0, 0.0, 0.0), "radius": 3 * DX, "material": RUBBER}


def ring(outer=0.020, inner=0.016, spacing=DX, **motion):
    """A ring in plane strain."""
    body = Body(
        shape="cylinder", base=(0.0, 0.0, 0.0), top=(0.0, 1.0, 0.0), radius=outer,
        inner_radius=inner, material=RUBBER, **motion,
    )  # fmt: skip
    return SphSolid(SphSolidParams(spacing=spacing, dimensions=2, bodies=(body,)))


def test_a_body_falls_freely():
    solid = SphSolid(SphSolidParams(spacing=DX, bodies=(Body(**BALL),), gravity=(0.0, 3.0, -9.81)))
    start, dt = solid.state.position.copy(), solid.stable_dt()
    energy = [solid.totals().potential + solid.totals().kinetic]
    for _ in range(50):
        solid.step(dt)
    time = 50 * dt
    g = np.array([0.0, 3.0, -9.81])
    np.testing.assert_allclose(
        solid.state.velocity, np.tile(time * g, (len(start), 1)), atol=1e-9 * time
    )
    np.testing.assert_allclose(
        solid.state.position - start,
        np.tile(0.5 * time**2 * g, (len(start), 1)),
        atol=1e-6 * time**2,
    )
    energy.append(solid.totals().potential + solid.totals().kinetic)
    assert energy[1] - energy[0] == pytest.approx(0.0, abs=1e-9 * solid.totals().kinetic)


@pytest.mark.parametrize("planes", [(), ("x",), ("x", "z")])
def test_rings_and_tubes_have_their_volumes(planes):
    symmetry = tuple(SymmetryPlane(axis=axis) for axis in planes)
    shape = {
        "shape": "cylinder", "base": (0.0, 0.4975, 0.0), "top": (0.0, 0.5025, 0.0),
        "radius": 0.010, "inner_radius": 0.006, "material": RUBBER,
    }  # fmt: skip
    area = 0.25 * math.pi * (0.020**2 - 0.012**2) / 2 ** len(planes)
    for dimensions, depth in ((2, 1.0), (3, 0.005)):
        params = SphSolidParams(
            spacing=DX, dimensions=dimensions, bodies=(Body(**shape),), symmetry=symmetry
        )
        solid = SphSolid(params)
        assert solid.totals().mass == pytest.approx(RHO * area * depth, rel=1e-12)
        assert expected_count(params) == pytest.approx(solid.items(), rel=0.1)


def test_a_mesh_is_filled_with_its_volume_and_its_motion(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    ball = trimesh.creation.icosphere(subdivisions=3, radius=4.0)
    ball.export(tmp_path / "ball.stl")
    body = Body(
        shape="mesh", file=str(tmp_path / "ball.stl"), scale=DX, origin=(0.1, 0.0, 0.0),
        material=RUBBER, velocity=(1.0, 2.0, 3.0), angular_velocity=(0.0, 0.0, 50.0),
    )  # fmt: skip
    solid = SphSolid(SphSolidParams(spacing=DX, bodies=(body,)))
    mass, total = solid.materials.mass(solid.state), solid.totals()
    assert total.mass == pytest.approx(RHO * ball.volume * DX**3, rel=1e-6)
    centre = mass @ solid.state.position / total.mass
    np.testing.assert_allclose(centre, [0.1, 0.0, 0.0], atol=0.02 * DX)
    np.testing.assert_allclose(total.momentum, total.mass * np.array([1.0, 2.0, 3.0]), rtol=0.01)
    x = solid.state.position[:, 0] - 0.1
    np.testing.assert_allclose(solid.state.velocity[:, 1], 2.0 + 50.0 * x, atol=1e-3)


def test_a_gradient_of_velocity_is_about_the_middle_of_the_body():
    rates = ((10.0, 20.0, 0.0), (0.0, -5.0, 0.0), (0.0, 0.0, 7.0))
    body = Body(**(BALL | {"centre": (1.0, 2.0, 3.0)}), velocity_gradient=rates)
    solid = SphSolid(SphSolidParams(spacing=DX, bodies=(body,)))
    arms = solid.state.position - np.array([1.0, 2.0, 3.0])
    np.testing.assert_allclose(solid.state.velocity, arms @ np.array(rates).T, atol=1e-12)


def test_a_spinning_ring_keeps_its_angular_momentum_and_grows_by_its_stress():
    """A spinning thin ring has the hoop stress ρ (ω R)²; its mean strain is this stress over E'."""
    rate, radius = 120.0, 0.018
    solid = ring(angular_velocity=(0.0, rate, 0.0))
    before, dt = solid.totals().angular_momentum[1], solid.stable_dt()
    position = solid.state.position
    assert solid.state.velocity[:, 0] == pytest.approx(rate * position[:, 2])
    # The ring oscillates about its equilibrium strain: take the mean over whole periods.
    modulus = E / (1.0 - NU**2)
    period = 2.0 * math.pi * radius / math.sqrt(modulus / RHO)
    mass, mean_radii = solid.materials.mass(solid.state), []
    for _ in range(round(2.0 * period / dt)):
        solid.step(dt)
        mean_radii.append(mass @ np.hypot(*solid.state.position[:, ::2].T) / mass.sum())
    strain = (
        np.mean(mean_radii) / (mass @ np.hypot(*solid.state.reference[:, ::2].T) / mass.sum()) - 1
    )
    assert strain == pytest.approx(RHO * (rate * radius) ** 2 / modulus, rel=0.05)
    assert solid.totals().angular_momentum[1] == pytest.approx(before, rel=1e-9)


def test_a_ring_breathes_at_its_frequency():
    """ω = √(E/(1 - ν²)ρ)/R of a thin ring in plane strain."""
    rate = 20.0
    solid = ring(velocity_gradient=((rate, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, rate)))
    modulus, radius = E / (1.0 - NU**2), 0.018
    period, dt = 2.0 * math.pi * radius / math.sqrt(modulus / RHO), solid.stable_dt()
    radial = []
    for _ in range(round(1.3 * period / dt)):
        solid.step(dt)
        x, z = solid.state.position[:, 0], solid.state.position[:, 2]
        u, w = solid.state.velocity[:, 0], solid.state.velocity[:, 2]
        radial.append(((u * x + w * z) / np.hypot(x, z)).mean())
    signs = np.sign(radial)
    crossings = np.flatnonzero(signs[:-1] != signs[1:]) * dt
    assert 2.0 * np.diff(crossings)[0] == pytest.approx(period, rel=0.02)


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"inner_radius": 0.03}, "inner_radius of a cylinder must be below"),
        ({"top": None}, "a cylinder is described by base and top and radius alone"),
        ({"top": (0.01, 0.0, 0.01)}, "up to its top along x, y or z"),
        ({"top": (0.0, 0.0, -0.01)}, "up to its top along x, y or z"),
        ({"file": "a.stl"}, "a cylinder is described by"),
    ],
)
def test_tubes_that_are_none_are_refused(settings, sentence):
    shape = {
        "shape": "cylinder", "base": (0.0, 0.0, 0.0), "top": (0.0, 0.0, 0.01), "radius": 0.01,
        "inner_radius": 0.005, "material": RUBBER,
    }  # fmt: skip
    if "file" in settings:
        settings = {"file": __file__}
    with pytest.raises(ValueError, match=sentence):
        Body(**(shape | settings))


@pytest.mark.parametrize(
    "motion", [{"angular_velocity": (1.0, 0.0, 0.0)}, {"velocity_gradient": ((0, 1, 0),) * 3}]
)
def test_motion_out_of_the_plane_is_refused_in_two_dimensions(motion):
    with pytest.raises(ValueError, match="angular_velocity is about y alone"):
        ring(**motion)


def test_gravity_out_of_the_plane_is_refused():
    box = Body(lowest=(0.0, 0.0, 0.0), highest=(0.01, 1.0, 0.01), material=RUBBER)
    with pytest.raises(ValueError, match="gravity must lie in the plane"):
        SphSolidParams(spacing=DX, dimensions=2, bodies=(box,), gravity=(0.0, 9.81, 0.0))


@pytest.mark.parametrize("side", ["+", "-"])
@pytest.mark.parametrize("low", [-2.5, -1.3])
def test_a_box_that_a_plane_of_symmetry_cuts_has_the_mass_of_its_part(side, low):
    ends = sorted(DX * x * (1.0 if side == "+" else -1.0) for x in (low, 2.5))
    body = Body(
        lowest=(ends[0], 0.0, 0.0), highest=(ends[1], 4 * DX, 4 * DX), material=RUBBER
    )  # fmt: skip
    plane = SymmetryPlane(axis="x", side=side)
    params = SphSolidParams(spacing=DX, bodies=(body,), symmetry=(plane,))
    solid = SphSolid(params)
    assert solid.totals().mass == pytest.approx(RHO * 2.5 * 16 * DX**3, rel=1e-12)
    assert np.abs(solid.state.position[:, 0]).min() > 0.4 * DX
    assert expected_count(params) == pytest.approx(solid.items(), rel=0.3)


def test_a_plane_of_symmetry_through_a_layer_of_a_ball_is_refused():
    plane = SymmetryPlane(axis="x", position=0.4 * DX)
    with pytest.raises(SceneError, match=r"between layers .* x = 0.0004 m is 0.0001 m from one"):
        SphSolid(SphSolidParams(spacing=DX, bodies=(Body(**BALL),), symmetry=(plane,)))


def test_velocities_off_the_plane_of_two_dimensions_are_refused():
    with pytest.raises(ValueError, match="velocity and velocity_gradient have nothing along y"):
        ring(velocity=(1.0, 2.0, 0.0))


def test_a_body_of_one_layer_is_refused_with_the_neighbours_of_the_start():
    thick = {"lowest": (0.0, 0.0, 0.0), "highest": (4 * DX, 4 * DX, 4 * DX), "material": RUBBER}
    thin = thick | {"lowest": (0.0, 0.0, 6 * DX), "highest": (4 * DX, 4 * DX, 7 * DX)}
    bodies = tuple(Body(**shape) for shape in (thick, thin))
    with pytest.raises(SceneError, match=r"bodies.1: .* found a body of one layer"):
        SphSolid(SphSolidParams(spacing=DX, bodies=bodies))


def test_particles_that_are_both_fixed_and_glued_are_refused():
    body = Body(lowest=(0.0, 0.0, 0.0), highest=(4 * DX, 4 * DX, 4 * DX), material=RUBBER)
    box = {"lowest": (0.0, 0.0, 0.0), "highest": (DX, 1.0, 1.0)}
    params = SphSolidParams(
        spacing=DX, bodies=(body,), fixed=(Fixed(**box, directions=("y",)),),
        glued=(Region(**box),),
    )  # fmt: skip
    with pytest.raises(SceneError, match=r"must not be fixed too, .* found 16 in boxes of both"):
        SphSolid(params)


def test_particles_that_come_off_a_mesh_bring_their_energy_in_gravity():
    body = Body(lowest=(0.0, 0.0, 0.0), highest=(4 * DX, 4 * DX, 4 * DX), material=RUBBER)
    region = Region(lowest=(0.0, 0.0, 0.0), highest=(DX, 1.0, 1.0))
    params = SphSolidParams(
        spacing=DX, bodies=(body,), glued=(region,), gravity=(0.0, 0.0, -9.81)
    )  # fmt: skip
    solid = SphSolid(params)
    state, mass = solid.state, solid.materials.mass(solid.state)
    loose = state.glue >= 0
    solid.take({"glue_activity.active": np.zeros(16)})
    assert state.work == pytest.approx(9.81 * mass[loose] @ state.position[loose, 2], rel=1e-12)
