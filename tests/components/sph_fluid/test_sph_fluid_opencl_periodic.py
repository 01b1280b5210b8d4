"""A tank repeats on an OpenCL device as on the processor."""

import numpy as np
import pytest
from device_fluids import DEVICE, DYNAMIC, MIRRORED, TWICE, advanced, difference, params_of

from quintet.components.sph_fluid.component import SphFluid

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
