"""A tank repeats on an OpenCL device as on the processor."""

import numpy as np
import pytest
from device_bodies import JOINED, Cube, require_close
from device_bodies import MIRRORED as MIRRORED_WALLS
from device_bodies import params_of as body_params
from device_fluids import DEVICE, DYNAMIC, MIRRORED, TWICE, advanced, difference, params_of

from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.component import Resources

pytest.importorskip("pyopencl")
from quintet.components.sph_fluid.opencl.device_fluid import DeviceFluid

TILTED = {"gravity": [9.0, 0.0, -4.0], "initial": {"velocity": [2.0, 0.0, 0.0]}}
SLAB = {"shape": "box", "lowest": [0.0, 0.0, 0.0], "highest": [0.8, 1.0, 0.4]}
STREAM = (
    MIRRORED
    | TILTED
    | {
        "fluid": [SLAB],
        "boundary": MIRRORED["boundary"] | {"open_faces": ["z+"], "periodic": ["x"]},
    }
)
CUBE = {"shape": "box", "lowest": [0.0, 0.0, 0.0], "highest": [0.8, 0.8, 0.4]}
WALLS = {"lowest": [0.0, 0.0, 0.0], "highest": [0.8, 0.8, 0.8]}
EDGES = (
    DYNAMIC
    | TWICE
    | TILTED
    | {
        "fluid": [CUBE],
        "boundary": {"method": "dbc", "walls": WALLS, "periodic": ["x", "y"]},
    }
)  # images have images


@pytest.mark.parametrize(
    ("table", "steps"),
    [(STREAM | {"viscosity": {"kinematic": 0.05}, "gauges": {}}, 120), (EDGES, 40)],
)
def test_what_leaves_at_one_face_enters_at_the_other_as_on_the_processor(table, steps):
    params = params_of(table)
    processor, device = SphFluid(params), DeviceFluid(params, DEVICE)
    for fluid in (processor, device):
        advanced(fluid, steps)
    assert device.stepping.rows.copies.count > 0
    assert difference(processor, device, "points") < 1e-13
    assert difference(processor, device, "density") < 1e-12
    first, second = processor.save(), device.save()
    assert first["crossings"].any()
    for key in ("identity", "crossings"):
        assert np.array_equal(first[key], second[key]), key
    assert device.totals().potential == pytest.approx(processor.totals().potential, rel=1e-12)
    assert not first["lost_through"].any()


@pytest.mark.parametrize("table", [STREAM | {"gauges": {}}, EDGES])
def test_threads_and_a_saved_state_change_no_bit(table):
    params = params_of(table)
    device, shared, loaded = (
        DeviceFluid(params, Resources(threads, device="opencl:0")) for threads in (1, 2, 1)
    )
    loaded.load(advanced(device, 30).save())
    advanced(shared, 30)
    first, *others = (advanced(fluid, 30).save() for fluid in (device, shared, loaded))
    for second in others:
        for key, array in first.items():
            assert np.array_equal(array, second[key], equal_nan=True), key


def test_snapshots_go_on_elsewhere():
    params = params_of(EDGES)
    processor, device = advanced(SphFluid(params), 20), advanced(DeviceFluid(params, DEVICE), 20)
    moved_out, moved_in = SphFluid(params), DeviceFluid(params, DEVICE)
    moved_out.load(device.save())
    moved_in.load(processor.save())
    advanced(processor, 20)
    for fluid in (moved_out, moved_in):
        assert difference(processor, advanced(fluid, 20), "points") < 1e-13


def test_a_body_that_passes_a_face_is_pushed_as_on_the_processor():
    params = body_params(
        **MIRRORED_WALLS, remove_inside_bodies=True, boundary__periodic=["x"],
        gravity=[1.0, 0.0, -9.81],
    )  # fmt: skip
    forces, fluids = [], (SphFluid(params), DeviceFluid(params, DEVICE))
    for fluid in fluids:
        cube = Cube(start=np.array([0.4, 0.25, 0.2]), speed=np.array([2.0, 0.0, 0.0]))
        fluid.bind(cube.static, JOINED)
        fluid.prime(cube.fields())
        forces.append(cube.push(fluid, 40))
    assert (cube.place + cube.arm)[:, 0].max() > 0.5  # m, the face
    assert np.abs(forces[1] - forces[0]).max() < 1e-9 * np.abs(forces[0]).max()
    require_close(*fluids)
