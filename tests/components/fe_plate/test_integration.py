"""Default numbers of integration points, and warnings where bending is too soft."""

import dataclasses

import meshio
import numpy as np
import pytest

from quintet.components.fe_plate.component import FePlate
from quintet.components.fe_plate.judgement import EVERY
from quintet.components.fe_plate.meshes.layers import MANY, fewest_layers
from quintet.components.fe_plate.meshes.params import Cutout, Part
from quintet.components.fe_plate.meshes.selections import Fixed
from quintet.components.fe_plate.params import FePlateParams
from quintet.components.fe_plate.plan import plan
from quintet.components.shared.materials.params import (
    JohnsonCook,
    JohnsonCookDamage,
    Material,
)
from quintet.interfaces.errors import SceneError

ELASTIC = Material(density=2700.0, youngs_modulus=7e10, poissons_ratio=0.0)
CALM = {"viscosity_linear": 0.0, "viscosity_quadratic": 0.0}


def beam(elements, **changes):
    part = Part(lowest=(0.0,) * 3, highest=(0.2, 0.01, 0.01), elements=elements, material=ELASTIC)
    return dataclasses.replace(part, **changes)


def cantilever(elements, **keys):
    fixed = (Fixed(lowest=(0.0,) * 3, highest=(0.0, 1.0, 1.0)),)
    params = {"parts": (beam(elements),), "fixed": fixed, "gravity": (0.0, 0.0, -9.81)}
    return FePlate(FePlateParams(**params | CALM | keys))


@pytest.mark.parametrize(("layers", "points"), [(1, 8), (4, 8), (7, 8), (8, 1), (12, 1)])
def test_thin_parts_have_eight_points_where_layers_are_few(layers, points):
    params = FePlateParams(parts=(beam((20, 8, layers)),))
    structure = FePlate(params)
    assert structure.places.point.shape[1] == points
    assert structure.items() == 160 * layers
    assert bool(structure.notes()) == bool(plan(params).notes) == (points == 8)


@pytest.mark.parametrize(
    "changes",
    [
        {"spall_stress": 1e9},
        {"damage": JohnsonCookDamage(d1=0.1), "johnson_cook": JohnsonCook(a=1e9)},
    ],
)
def test_what_shocks_or_fails_keeps_one_point_and_says_what_it_lacks(changes):
    law = dataclasses.replace(ELASTIC, **changes)
    structure = FePlate(FePlateParams(parts=(beam((20, 8, 4), material=law),)))
    (note,) = structure.notes()
    assert structure.places.point.shape[1] == 1
    assert "parts.0 has 4 elements" in note and "1/n² = 6% of its stiffness" in note


def test_layers_are_counted_in_boxes_cylinders_and_cutouts():
    assert fewest_layers(beam((4, 3, 5))) == 3
    cube = {"lowest": (0.0,) * 3, "highest": (1.0, 1.0, 1.0), "elements": (9, 9, 9)}
    block = Part(**cube, material=ELASTIC)
    assert fewest_layers(block) == MANY
    web = Cutout(lowest=(0.3, 0.0, 0.0), highest=(1.0, 1.0, 1.0))
    assert fewest_layers(dataclasses.replace(block, cutout=web)) == 3
    rod = Part(
        shape="cylinder",
        base=(0.0, 0.0, 0.0),
        top=(0.0, 0.0, 1.0),
        radius=0.1,
        elements=(2, 1, 20),
        material=ELASTIC,
    )
    assert fewest_layers(rod) == 6
    flat = dataclasses.replace(rod, top=(0.0, 0.0, 0.05), elements=(9, 9, 2))
    assert fewest_layers(flat) == 2


@pytest.mark.parametrize("layers", [1, 3, 9])
def test_layers_of_a_mesh_are_counted_from_side_to_side(tmp_path, layers):
    structure = FePlate(FePlateParams(parts=(beam((12, layers, 10)),), integration="reduced"))
    cells = [("hexahedron", structure.mesh.corner)]
    meshio.Mesh(structure.mesh.node, cells).write(tmp_path / "beam.vtk")
    part = Part(shape="mesh", file=str(tmp_path / "beam.vtk"), material=ELASTIC)
    assert fewest_layers(part) == (layers if layers < 8 else MANY)


def test_a_cantilever_of_few_layers_bends_as_beam_theory_has_it():
    """It swings to twice its static deflection; reduced, two layers lack a third."""
    deflection = 2700.0 * 9.81 * 0.2**4 / (8.0 * 7e10 * 0.01**2 / 12.0)  # m
    structure = cantilever((20, 1, 2))
    lowest = 0.0
    while structure.accumulated.time < 2.7e-3:
        structure.step(structure.stable_dt())
        lowest = min(
            lowest,
            float(structure.state.position[structure.mesh.node[:, 0] == 0.2, 2].mean() - 5e-3),
        )
    assert lowest == pytest.approx(-2.0 * deflection, rel=0.03)
    assert not structure.warnings()


def test_bending_that_the_stabilisation_bears_is_warned_of_and_the_warning_is_part_of_the_state():
    structure = cantilever((20, 1, 2), integration="reduced")
    for _ in range(4 * EVERY + 1):
        structure.step(structure.stable_dt())
    (text,) = structure.warnings().values()
    assert "one quadrature point does not see" in text and 'integration = "full"' in text
    resumed = cantilever((20, 1, 2), integration="reduced")
    assert not resumed.warnings()
    resumed.load(structure.save())
    assert resumed.warnings() == structure.warnings()


def test_a_stabilisation_that_is_too_stiff_is_warned_of():
    structure = cantilever((20, 1, 8), integration="reduced", hourglass=2.0)
    for _ in range(8 * EVERY + 1):
        structure.step(structure.stable_dt())
    assert set(structure.warnings()) == {"hourglass"}


def test_viscosity_that_takes_the_motion_of_an_elastic_block_is_warned_of():
    part = beam((20, 2, 2), velocity=(0.0, 0.0, 0.0))
    for viscosity, subjects in ((0.0, set()), (5.0, {"viscosity"})):
        block = FePlate(FePlateParams(parts=(part,), **CALM | {"viscosity_linear": viscosity}))
        block.state.velocity[:, 0] = -np.sin(np.pi * (block.mesh.node[:, 0] / 0.2 - 0.5))
        for _ in range(6 * EVERY + 1):
            block.step(block.stable_dt())
        assert set(block.warnings()) >= subjects and bool(block.warnings()) == bool(subjects)


def test_energy_that_nothing_brings_is_warned_of():
    structure = cantilever((20, 1, 1))
    structure.state.velocity[structure.mesh.node[:, 0] > 0.15, 2] = 1.0
    for _ in range(EVERY):
        structure.step(structure.stable_dt())
    assert not structure.warnings()
    structure.state.velocity[:] *= 1.1
    for _ in range(EVERY):
        structure.step(structure.stable_dt())
    assert set(structure.warnings()) == {"energy"}


def test_a_stabilisation_of_nothing_is_refused():
    with pytest.raises(SceneError, match=r"hourglass must be 0\.001 or more"):
        plan(FePlateParams(parts=(beam((8, 8, 8)),), hourglass=0.0))
    plan(FePlateParams(parts=(beam((8, 8, 8)),), hourglass=0.0, integration="full"))
    plan(
        FePlateParams(parts=(dataclasses.replace(beam((8, 8, 8)), tetrahedra=True),), hourglass=0.0)
    )
