"""Bodies on a device touch the faces of a partner's mesh as those on the processor do."""

import numpy as np
import pytest
from device_solids import DEVICE, RUBBER, SPACING, differing, params_of, require_close

from quintet.components.sph_solid.component import SphSolid
from quintet.components.sph_solid.conform import CORNERS, FACE

pytest.importorskip("pyopencl")
from quintet.components.sph_solid.opencl.device_solid import DeviceSolid

LOAD = "contact_load.force"


def block(material, speed, **changes):
    """A block that falls onto the face of `FACE`, and slides along it."""
    body = {
        "lowest": [0.0, 0.0, 1e-4], "highest": [0.05, 0.04, 0.0401], "material": material,
        "velocity": [0.2 * speed, 0.0, -speed],
    }  # fmt: skip
    return {"spacing": SPACING, "bodies": [body], "contact_with_faces": True} | changes


KEPT = block(RUBBER, 5.0, gauges=[[0.025, 0.02, 0.0]])
SORTED = block("steel", 300.0, symmetry=[{"axis": "y"}])


def bound(kind, params, *resources):
    solid = kind(params, *resources)
    solid.bind(FACE, frozenset({"contact_faces"}))
    return solid


def moved(solid, steps, first=0):
    """Advance a solid over a face that sinks and is gone at the end; forces on its nodes."""
    forces = []
    for number in range(first, first + steps):
        fields = {
            "contact_faces.position": CORNERS - (0.0, 0.0, 1e-6 * number),
            "contact_faces.velocity": np.zeros((4, 3)),
            "contact_activity.active": np.full(1, float(number < 90)),
        }
        solid.take(fields)
        solid.step(min(solid.stable_dt(), 2e-5))
        forces.append(solid.give(frozenset({LOAD}))[LOAD])
    return np.array(forces)


@pytest.mark.parametrize("table", [KEPT, SORTED])
def test_faces_push_bodies_of_a_device_as_those_of_the_processor(table):
    params = params_of(table)
    processor, device = bound(SphSolid, params), bound(DeviceSolid, params, DEVICE)
    expected, computed = moved(processor, 100), moved(device, 100)
    largest = np.abs(expected).max()
    assert largest > 0.0 and np.abs(computed - expected).max() < 1e-10 * largest
    require_close(processor, device)
    first, second = processor.totals(), device.totals()
    assert second.dissipated == pytest.approx(first.dissipated, rel=1e-9)
    assert second.kinetic == pytest.approx(first.kinetic, rel=1e-10)
    assert device.warnings() == processor.warnings()


def test_gauges_on_a_device_have_the_half_of_the_force_that_belongs_to_a_step():
    params = params_of(KEPT)
    solids = bound(SphSolid, params), bound(DeviceSolid, params, DEVICE)
    names = frozenset({"gauges.velocity"})
    expected, computed = (
        (moved(solid, 20), solid.give(names)["gauges.velocity"])[1] for solid in solids
    )
    assert computed == pytest.approx(expected, rel=1e-10)
    assert np.abs(solids[1].host.faces.penalty.kicked).max() > 0.0


@pytest.mark.parametrize("table", [KEPT, SORTED])
def test_snapshots_of_bodies_on_faces_go_on_elsewhere(table):
    params = params_of(table)
    device, processor = bound(DeviceSolid, params, DEVICE), bound(SphSolid, params)
    moved(device, 20), moved(processor, 20)
    same, out, back = (
        bound(DeviceSolid, params, DEVICE),
        bound(SphSolid, params),
        bound(DeviceSolid, params, DEVICE),
    )
    same.load(device.save()), out.load(device.save()), back.load(processor.save())
    for solid in (device, same, out, back, processor):
        moved(solid, 20, 20)
    assert differing(device.save(), same.save()) == []
    for solid in (out, back):
        require_close(processor, solid)


def test_a_body_of_a_device_that_no_link_joins_to_faces_falls_freely():
    params = params_of(KEPT)
    device = DeviceSolid(params, DEVICE)
    device.bind({}, frozenset())
    device.step(1e-5)
    assert device.give(frozenset({LOAD}))[LOAD].shape == (0, 3)
    assert device.save()["velocity"][:, 2] == pytest.approx(-5.0)
