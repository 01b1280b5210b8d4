"""Meshes of structures, and what is measured in them."""

import math

import numpy as np
import pytest

from quintet.components.fe_plate.component import FePlate
from quintet.components.fe_plate.meshes.params import Cylinder, Part
from quintet.components.fe_plate.params import Faces, FePlateParams, Gauges, Pressure
from quintet.components.shared.materials.params import Material

ELASTIC = Material(density=2700.0, youngs_modulus=7e10, poissons_ratio=0.3)


def bar(axis="z", quarter=False, elements=(3, 3, 8), **given):
    shape = Cylinder(
        base=(0.1, 0.2, 0.3),
        axis=axis,
        radius=0.01,
        length=0.05,
        elements=elements,
        quarter=quarter,
    )
    part = Part(cylinder=shape, material=ELASTIC)
    return FePlate(FePlateParams(parts=(part,), **given))


@pytest.mark.parametrize("axis", ["x", "y", "z"])
@pytest.mark.parametrize("quarter", [False, True])
def test_a_cylinder_has_its_volume_and_its_elements(axis, quarter):
    share = 0.25 if quarter else 1.0
    made = bar(axis, quarter)
    assert made.items() == made.params.parts[0].count == share * 4 * 3 * 9 * 8
    rim = 12 * 2  # corners of the circle
    area = 0.5 * rim * math.sin(2.0 * math.pi / rim) * 0.01**2
    assert made.volume.sum() == pytest.approx(share * area * 0.05, rel=1e-12)
    assert made.volume.min() > 0.4 * made.volume.max()
    used = np.unique(made.mesh.corner)
    assert len(used) == len(made.mesh.node)  # none twice, none alone
    middle = 0.5 * (made.mesh.node.min(axis=0) + made.mesh.node.max(axis=0))
    along = "xyz".index(axis)
    assert middle[along] == pytest.approx((0.1, 0.2, 0.3)[along] + 0.025)


def test_a_uniform_pressure_on_a_cylinder_pushes_it_nowhere():
    everywhere = Faces(lowest=(-1.0, -1.0, -1.0), highest=(1.0, 1.0, 1.0))
    made = bar(pressures=(Pressure(faces=everywhere, pressure=1e6),))
    made.step(1e-9)
    push = np.abs(made.state.load).sum()
    assert np.abs(made.state.load.sum(axis=0)).max() < 1e-12 * push


def test_gauges_give_what_nodes_elements_and_parts_have():
    still = Part(
        lowest=(0.0, 0.0, 0.0), highest=(1.0, 1.0, 1.0), elements=(2, 2, 2), material="steel"
    )
    moving = Part(
        lowest=(3.0, 0.0, 0.0),
        highest=(4.0, 1.0, 1.0),
        elements=(3, 1, 1),
        material=ELASTIC,
        velocity=(7.0, 0.0, 0.0),
    )
    gauges = Gauges(
        node_gauges=((4.0, 0.9, 0.9),), element_gauges=((0.3, 0.2, 0.9),), part_gauge=True
    )
    made = FePlate(FePlateParams(parts=(still, moving), gauges=gauges))
    keys = {f"{port.name}.{field.name}" for port in made.gives for field in port.fields}
    found = made.give(frozenset(keys))
    assert keys == set(found)
    np.testing.assert_array_equal(found["node_gauge.position"], [[4.0, 1.0, 1.0]])
    np.testing.assert_array_equal(found["node_gauge.velocity"], [[7.0, 0.0, 0.0]])
    assert found["element_gauge.temperature"] == pytest.approx([298.0])
    assert found["part_gauge.velocity"] == pytest.approx(np.array([[0.0] * 3, [7.0, 0.0, 0.0]]))
    assert found["part_gauge.kinetic"] == pytest.approx([0.0, 0.5 * 2700.0 * 49.0])
    for _ in range(30):
        made.step(made.stable_dt())
    totals, found = made.totals(), made.give(frozenset(keys))
    assert found["part_gauge.kinetic"].sum() == pytest.approx(totals.kinetic, rel=1e-12)
    assert found["part_gauge.internal"].sum() == pytest.approx(totals.internal, abs=1e-9)
