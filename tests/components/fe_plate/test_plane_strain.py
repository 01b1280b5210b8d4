"""Structures in two dimensions: plane strain, edges for faces, forces on 1 m."""

import numpy as np
import pytest

from quintet.components.fe_plate.component import FePlate
from quintet.components.fe_plate.meshes.params import Part
from quintet.components.fe_plate.meshes.selections import Faces, Fixed
from quintet.components.fe_plate.params import FePlateParams, Pressure, RigidWall
from quintet.components.shared.materials.params import Material

INTEGRATIONS = pytest.mark.parametrize("integration", ["reduced", "full"])
EVERYWHERE = Faces(lowest=(-9.0, -9.0, -9.0), highest=(9.0, 9.0, 9.0))


def slab(dimensions, **keys):
    part = Part(
        lowest=(0.0, 0.0, 0.0),
        highest=(0.04, 1.0, 0.02),
        elements=(8, 1, 4),
        material="steel",
        velocity=(5.0, 0.0, -60.0),
    )
    return FePlate(FePlateParams(parts=(part,), dimensions=dimensions, **keys))


@INTEGRATIONS
def test_it_moves_as_a_slab_that_is_held_along_y(integration):
    """To rounding; eight points have axes that begin with another edge of the deformed element."""
    tolerance = 1e-9 if integration == "reduced" else 3e-3
    wall = RigidWall(point=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0))
    clamp = Fixed(lowest=(-9.0, -9.0, -9.0), highest=(9.0, 9.0, 9.0), directions=("y",))
    keys = {"rigid_walls": (wall,), "integration": integration, "gravity": (0.0, 0.0, -9.81)}
    flat, solid = slab(2, **keys), slab(3, fixed=(clamp,), **keys)
    for _ in range(150):
        dt = min(flat.stable_dt(), solid.stable_dt())
        flat.step(dt)
        solid.step(dt)
    front = solid.mesh.node[:, 1] == 0.0
    displacement = flat.state.position - flat.mesh.node
    np.testing.assert_allclose(
        displacement,
        (solid.state.position - solid.mesh.node)[front],
        atol=tolerance * np.abs(displacement).max(),
    )
    flat_totals, solid_totals = flat.totals(), solid.totals()
    assert flat_totals.mass == pytest.approx(7850.0 * 0.04 * 0.02)
    assert flat_totals.kinetic == pytest.approx(solid_totals.kinetic, rel=tolerance)
    assert flat_totals.internal == pytest.approx(solid_totals.internal, rel=tolerance)


def test_edges_go_round_with_the_inside_on_their_left():
    structure = slab(2)
    edge = structure.describe()["faces.corner"].astype(int)
    assert len(edge) == 24 and (edge[:, 2:] == -1).all()
    assert structure.describe()["faces.dimensions"] == [2.0]
    start = structure.describe()["faces.start"]
    assert (start[:, 1] == 0.0).all()
    first, last = start[edge[:, 0]], start[edge[:, 1]]
    area = 0.5 * (first[:, 0] * last[:, 2] - last[:, 0] * first[:, 2]).sum()
    assert area == pytest.approx(0.04 * 0.02)


def test_a_pressure_pushes_inwards_with_its_edges_length():
    top = Faces(lowest=(-1.0, -1.0, 0.02), highest=(1.0, 1.0, 0.02))
    structure = slab(2, pressures=(Pressure(faces=top, pressure=1e5),))
    structure.step(1e-9)
    np.testing.assert_allclose(structure.state.load.sum(axis=0), [0.0, 0.0, -1e5 * 0.04], atol=1e-9)
    even = slab(2, pressures=(Pressure(faces=EVERYWHERE, pressure=1e5),))
    even.step(1e-9)
    assert np.abs(even.state.load.sum(axis=0)).max() < 1e-8
    assert (even.state.load * (even.mesh.node - [0.02, 0.0, 0.01])).sum() < 0.0


@INTEGRATIONS
def test_a_strip_under_pressure_bends_as_plane_strain_has_it(integration):
    """w = q L⁴/(384 D) of a clamped strip, and q L²/(8 κ G h) of its shear, κ = 5/6."""
    length, height, load = 0.3, 0.01, 1e4
    part = Part(
        lowest=(0.0, 0.0, 0.0),
        highest=(length, 1.0, height),
        elements=(30, 1, 8 if integration == "reduced" else 1),
        material=Material(density=2700.0, youngs_modulus=7e10, poissons_ratio=0.3),
    )
    ends = tuple(Fixed(lowest=(x, 0.0, 0.0), highest=(x, 0.0, height)) for x in (0.0, length))
    top = Faces(lowest=(0.0, 0.0, height), highest=(length, 0.0, height))
    structure = FePlate(
        FePlateParams(
            parts=(part,),
            fixed=ends,
            pressures=(Pressure(faces=top, pressure=load),),
            dimensions=2,
            integration=integration,
            mass_damping=12000.0,
            viscosity_linear=0.0,
            viscosity_quadratic=0.0,
        )
    )
    dt = structure.stable_dt()
    for _ in range(round(0.0035 / dt)):
        structure.step(dt)
    middle = np.flatnonzero(np.abs(structure.mesh.node[:, 0] - 0.5 * length) < 1e-9)
    deflection = (structure.state.position - structure.mesh.node)[middle, 2].mean()
    rigidity = 7e10 * height**3 / 12.0 / (1.0 - 0.3**2)
    shear = 7e10 / 2.6
    bending = load * length**4 / 384.0 / rigidity
    assert deflection == pytest.approx(
        -bending - load * length**2 * 1.2 / 8.0 / shear / height, rel=0.02
    )


def test_a_part_that_is_no_slab_is_refused():
    part = Part(
        lowest=(0.0, 0.0, 0.0), highest=(1.0, 0.5, 1.0), elements=(2, 1, 2), material="steel"
    )
    with pytest.raises(ValueError, match=r"1 m deep along y in one element; found 0\.5 m"):
        FePlateParams(parts=(part,), dimensions=2)


def test_cylinders_and_meshes_of_files_are_refused(tmp_path):
    file = tmp_path / "bar.inp"
    file.touch()
    round_bar = Part(
        shape="cylinder",
        base=(0.0, 0.0, 0.0),
        top=(0.0, 0.0, 1.0),
        radius=0.1,
        elements=(2, 2, 1),
        material="steel",
    )
    meshed = Part(shape="mesh", file=str(file), material="steel")
    for part, kind in ((round_bar, "cylinder"), (meshed, "mesh")):
        with pytest.raises(ValueError, match=f"it must be a box, .* found a {kind}"):
            FePlateParams(parts=(part,), dimensions=2)
