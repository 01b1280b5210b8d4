"""Shapes contain their volume; all scenes and kinds use the same keys for a shape."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from quintet.components.shared.geometry.planar_shapes import Polygon
from quintet.components.shared.geometry.polygons import area_moments
from quintet.components.shared.geometry.shape_keys import NEEDS, shape_of
from quintet.components.shared.geometry.shapes import Box, Cylinder, Sphere
from quintet.coupler.reference.sections import sections
from quintet.coupler.scene.read import library, parse
from quintet.interfaces.manifest import find, known_kinds

OLD = {"diameter", "inner_diameter", "size"}
SHAPES = {
    "box": Box(lowest=(0.1, -0.2, 0.3), highest=(0.5, 0.2, 0.5)),
    "sphere": Sphere(centre=(1.0, 2.0, 3.0), radius=0.4),
    "cylinder": Cylinder(base=(1.0, 0.0, 2.0), top=(1.0, 0.7, 2.0), radius=0.3),
    "tube": Cylinder(base=(1.0, 0.0, 2.0), top=(1.0, 0.0, 2.7), radius=0.3, inner_radius=0.2),
}


@pytest.mark.parametrize("name", SHAPES)
def test_a_shape_contains_its_share_of_its_bounds(name):
    shape = SHAPES[name]
    axes = [
        low + (np.arange(60) + 0.5) * (high - low) / 60
        for low, high in zip(*shape.bounds, strict=True)
    ]
    inside = shape.contains(*np.meshgrid(*axes, indexing="ij", sparse=True))
    assert inside.mean() == pytest.approx(shape.share, rel=2e-2)
    assert not shape.contains(*(axis + 10.0 for axis in axes)).any()


@pytest.mark.parametrize("name", SHAPES)
def test_volume_and_inertia_are_those_of_what_a_shape_contains(name):
    shape = SHAPES[name]
    edges = [high - low for low, high in zip(*shape.bounds, strict=True)]
    axes = [edge * ((np.arange(60) + 0.5) / 60 - 0.5) for edge in edges]
    arm = np.stack([place.ravel() for place in np.meshgrid(*axes, indexing="ij")])
    centre = 0.5 * np.sum(shape.bounds, axis=0)
    inside = arm[:, shape.contains(*(arm + centre[:, None]))]
    cell = math.prod(edges) / 60**3
    assert shape.volume == pytest.approx(cell * inside.shape[1], rel=2e-2)
    second_moment = inside @ inside.T * cell
    inertia = np.trace(second_moment) * np.eye(3) - second_moment
    assert shape.inertia == pytest.approx(inertia, rel=3e-2, abs=1e-3 * np.trace(inertia))


def test_edges_and_middles_of_boxes_are_those_of_decimal_numbers():
    box = Box(lowest=(5.2, 0.275, 0.15), highest=(5.35, 0.425, 0.3))
    assert 5.35 - 5.2 != 0.15  # as binary numbers
    assert box.size == (0.15, 0.15, 0.15) and box.centre == (5.275, 0.35, 0.225)


def test_a_polygon_fills_its_area_whichever_way_its_corners_go():
    corners = ((0.0, 0.0), (0.3, 0.0), (0.0, 0.2))
    for ordered_corners in (corners, corners[::-1]):
        polygon = Polygon(corners=ordered_corners, origin=(1.0, 2.0, 3.0))
        low, high = polygon.bounds
        assert polygon.share * 0.3 * 0.2 == pytest.approx(0.03)
        assert area_moments(polygon.outline).area == pytest.approx(0.03)
        assert (low, high) == ((1.0, 1.5, 3.0), (1.3, 2.5, 3.2))


@pytest.mark.parametrize(
    ("table", "sentence"),
    [
        ({"shape": "box", "lowest": (0.0,) * 3}, "a box is described by lowest and highest alone"),
        ({"shape": "box", "lowest": (1.0,) * 3, "highest": (0.0,) * 3}, "body: a box must go from"),
        ({"shape": "sphere", "centre": (0.0,) * 3, "radius": 1.0, "top": (1.0,) * 3}, "top"),
    ],
)
def test_tables_that_describe_no_shape_are_refused(table, sentence):
    with pytest.raises(ValueError, match=sentence):
        shape_of(SimpleNamespace(**table), "body")


def tables(value):
    """All tables within a scene."""
    if isinstance(value, dict):
        yield value
    for inner in value.values() if isinstance(value, dict) else value:
        if isinstance(inner, dict | list):
            yield from tables(inner)


@pytest.mark.parametrize("name", library())
def test_every_scene_spells_shapes_one_way(name):
    scene = parse(library()[name])
    scene = {key: value for key, value in scene.items() if key != "studies"}
    for table in tables(scene.get("components", {})):
        assert not OLD & set(table), table
        needed = NEEDS.get(table.get("shape", ""), ())
        assert set(needed) <= set(table), table
    for preset in scene.get("presets", {}).values():
        assert not OLD & {name.rpartition(".")[2] for name in preset}


@pytest.mark.parametrize("kind", sorted(known_kinds()))
def test_every_kind_spells_spheres_one_way(kind):
    for section in sections(find(kind).params):
        names = {key.name for key in section.keys}
        assert not OLD & names, section.head
        if "radius" in names and not names & {"base", "length"}:
            assert "centre" in names and "position" not in names, section.head


def test_shares_are_those_of_the_field():
    assert SHAPES["sphere"].share == math.pi / 6.0
    assert SHAPES["tube"].share == pytest.approx(0.25 * math.pi * (1.0 - (2.0 / 3.0) ** 2))
