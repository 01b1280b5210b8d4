"""Faces that contact touches while elements erode: the outer faces of what is left."""

import json

import numpy as np
import pytest
from pydantic import TypeAdapter

from quintet.components.fe_plate.component import FePlate
from quintet.components.fe_plate.meshes.mesh import outer_edges, outer_sides
from quintet.components.fe_plate.params import FePlateParams
from quintet.components.fe_plate.state import ACTIVE, LANES

BRITTLE = {
    "density": 2700.0, "youngs_modulus": 7e10, "poissons_ratio": 0.3, "spall_stress": 1e9,
}  # fmt: skip
PART = {"lowest": [0.0] * 3, "highest": [0.04, 0.03, 0.02], "elements": [4, 3, 2],
        "material": BRITTLE}  # fmt: skip
ASKED = {"contact_surface.inner": np.ones(1)}
KINDS = {
    "bricks": PART,
    "tetrahedra": {**PART, "tetrahedra": True},
    "plane": {**PART, "highest": [0.04, 1.0, 0.02], "elements": [4, 1, 3]},
}


def plate(*parts, **keys):
    document = json.dumps({"parts": parts, **keys})
    return FePlate(TypeAdapter(FePlateParams).validate_json(document))


def touched(structure):
    """Nodes of the mesh at each face, and which faces are open."""
    listed = structure.sample(ASKED)
    start, corner = listed["contact_surface.start"], listed["contact_surface.corner"].astype(int)
    mesh = structure.mesh.node
    node = np.array([np.flatnonzero((mesh == place).all(axis=1))[0] for place in start])
    active = structure.give(frozenset({"open_faces.active"}))["open_faces.active"]
    return np.where(corner < 0, -1, node[corner]), active, listed


def as_set(side):
    """Faces with their sense: corners from the least one on."""
    turned = (np.roll(row[row >= 0], -int(np.argmin(row[row >= 0]))) for row in side)
    return {tuple(row) for row in turned}


def erode(structure, elements):
    blocks, lanes = np.divmod(structure.places.point[elements].ravel(), LANES)
    structure.state.points[blocks, ACTIVE, lanes] = 0.0


@pytest.mark.parametrize("kind", KINDS)
def test_faces_are_open_that_bound_what_is_left(kind):
    structure = plate(KINDS[kind], dimensions=2 if kind == "plane" else 3, integration="auto")
    mesh, rng = structure.mesh, np.random.default_rng(1)
    outer = outer_edges if kind == "plane" else outer_sides
    left = np.ones(len(mesh.corner), bool)
    for share in (0.0, 0.2, 0.5, 1.0):
        gone = np.flatnonzero(rng.random(len(left)) < share)
        erode(structure, gone)
        left[gone] = False
        side, active, listed = touched(structure)
        bound = side[active == 1.0]
        assert set(np.unique(active)) <= {0.0, 1.0}
        assert as_set(bound) == as_set(outer(mesh.corner[left])[0])
        assert len(bound) == len(as_set(bound))
    # Those that were described stand first, behind them what they are made of.
    described = structure.describe()
    for key in ("start", "corner", "mass", "bulk", "shear", "thickness"):
        first = described[f"contact_surface.{key}"]
        np.testing.assert_array_equal(listed[f"contact_surface.{key}"][: len(first)], first)


def test_thickness_and_mass_of_inner_faces_are_those_of_the_elements_behind():
    _, _, listed = touched(structure := plate(PART))
    np.testing.assert_allclose(listed["contact_surface.thickness"], 0.01)
    assert listed["contact_surface.mass"].sum() == pytest.approx(structure.built.mass.sum())


def test_only_parts_that_may_erode_and_are_seen_list_inner_faces():
    tough = {**PART, "lowest": [0.1, 0.0, 0.0], "highest": [0.14, 0.03, 0.02],
             "material": {key: BRITTLE[key] for key in list(BRITTLE)[:3]}}  # fmt: skip
    unseen = {**PART, "lowest": [0.2, 0.0, 0.0], "highest": [0.24, 0.03, 0.02]}
    top = {"lowest": [0.0, 0.0, 0.02], "highest": [0.14, 0.03, 0.02]}
    structure = plate(PART, tough, unseen, coupled_faces=[top])
    side, active, _ = touched(structure)
    inner = side[len(structure.faces) :]
    assert active[: len(structure.faces)].all() and not active[len(structure.faces) :].any()
    assert len(inner) == 2 * (3 * 3 * 2 + 4 * 2 * 2 + 4 * 3)
    assert structure.mesh.node[inner].max(axis=(0, 1))[0] <= 0.04
    takes = {port.name for port in structure.takes}
    assert "contact_surface_load" in takes
    assert "contact_surface_load" not in {port.name for port in plate(tough).takes}
    assert "contact_surface_load" not in {port.name for port in plate(PART, erosion=[]).takes}


def test_forces_of_contact_act_on_inner_nodes_beside_other_loads():
    structure, number = plate(PART), 5
    structure.sample(ASKED)
    structure.bind({}, frozenset({"contact_surface", "contact_surface_load", "node_load"}))
    force = np.zeros((structure.loaded.size, 3))
    force[-1], more = (1.0, 2.0, 3.0), np.zeros((len(structure.surface), 3))
    more[number] = (0.5, 0.0, 0.0)
    structure.take({"contact_surface_load.force": force, "node_load.force": more})
    structure.step(1e-8)
    np.testing.assert_allclose(structure.totals().momentum, 1e-8 * np.array([1.5, 2.0, 3.0]))
    saved, other = structure.save(), plate(PART)
    other.bind({}, frozenset({"node_load"}))
    other.begin_from(saved)  # without the partner that touched it
    np.testing.assert_array_equal(other.state.velocity, structure.state.velocity)
    structure.begin_from(other.save())
    np.testing.assert_array_equal(structure.loads[-1], 0.0)
