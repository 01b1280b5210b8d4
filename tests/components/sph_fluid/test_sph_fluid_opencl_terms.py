"""Terms that scenes add to a fluid on an OpenCL device act as on the processor."""

from copy import deepcopy

import numpy as np
import pytest
from device_fluids import DEVICE, DYNAMIC, MIRRORED, TWICE, advanced, difference, params_of

from quintet.components.sph_fluid.component import SphFluid
from quintet.components.sph_fluid.conform import FLUME, PUSHED, ROLLING

pytest.importorskip("pyopencl")
from quintet.components.sph_fluid.opencl.device_fluid import DeviceFluid

DAMPED = {"acoustic_damper": 0.5, "integration": "symplectic"}
TERMS = [
    MIRRORED | DAMPED,
    DYNAMIC | DAMPED | {"xsph": 0.3, "density_diffusion": 0.1},
    MIRRORED | {"shepard_every": 7, "xsph": 0.5},
]


@pytest.mark.parametrize("table", TERMS)
def test_terms_that_scenes_add_act_as_on_the_processor(table):
    params = params_of(table)
    processor, device = advanced(SphFluid(params), 60), advanced(DeviceFluid(params, DEVICE), 60)
    assert difference(processor, device, "points") < 1e-13
    first, second = processor.save(), device.save()
    for key in ("position_density", "minus_rho_div_u"):
        largest = np.abs(first[key]).max(initial=1e-300)
        assert np.abs(first[key] - second[key]).max(initial=0.0) < 1e-10 * largest, key


def test_a_damped_fluid_goes_on_from_a_snapshot_with_the_same_bits():
    params = params_of(TERMS[1])
    device, loaded = DeviceFluid(params, DEVICE), DeviceFluid(params, DEVICE)
    loaded.load(advanced(device, 20).save())
    first, second = advanced(device, 20).save(), advanced(loaded, 20).save()
    for key, array in first.items():
        assert np.array_equal(array, second[key], equal_nan=True), key


ROLLED = {"motion": ROLLING["motion"] | {"amplitude": [0.05, 0.0, 0.0]}}


@pytest.mark.parametrize(
    "table",
    [
        MIRRORED | {"boundary": MIRRORED["boundary"] | ROLLED},
        DYNAMIC | TWICE | {"boundary": DYNAMIC["boundary"] | ROLLED},
        pytest.param(
            MIRRORED | TWICE | {"boundary": MIRRORED["boundary"] | ROLLED, "precision": "float32"},
            marks=pytest.mark.full,
        ),
    ],
)
def test_tanks_move_as_on_the_processor(table):
    params = params_of(table)
    processor, device = advanced(SphFluid(params), 80), advanced(DeviceFluid(params, DEVICE), 80)
    limit = 1e-5 if "precision" in table else 1e-12
    assert difference(processor, device, "points") < limit
    first, second = processor.save()["motion"], device.save()["motion"]
    assert first[1] != 0.0  # work of the motion
    assert second == pytest.approx(first, rel=1e-3 if "precision" in table else 1e-9)
    loaded = DeviceFluid(params, DEVICE)
    loaded.load(device.save())
    device_state, loaded_state = advanced(device, 10).save(), advanced(loaded, 10).save()
    for key, array in device_state.items():
        assert np.array_equal(array, loaded_state[key], equal_nan=True), key


VISCOUS = {"viscosity": {"kinematic": 0.05}}


@pytest.mark.parametrize(
    "changes",
    [
        VISCOUS,
        {"viscosity": {"kinematic": 0.05, "form": "stress"}, "precision": "float32"},
    ],
)
def test_fluid_with_kinematic_viscosity_sticks_to_walls_as_on_the_processor(changes):
    params = params_of(MIRRORED | changes)
    processor, device = advanced(SphFluid(params), 60), advanced(DeviceFluid(params, DEVICE), 60)
    limit = 1e-4 if "precision" in changes else 2e-7
    assert difference(processor, device, "velocity") < limit


PISTONS = [
    FLUME | TWICE,
    DYNAMIC | {"boundary": DYNAMIC["boundary"] | {"pistons": PUSHED["pistons"]}},
]


@pytest.mark.parametrize("table", PISTONS)
def test_pistons_and_damping_zones_act_as_on_the_processor(table):
    params = params_of(table)
    fluids = SphFluid(params), DeviceFluid(params, DEVICE), DeviceFluid(params, DEVICE)
    for fluid in fluids:
        fluid.bind({}, frozenset())
    processor, device, loaded = fluids
    advanced(processor, 60), advanced(device, 60)
    assert difference(processor, device, "points") < 1e-12
    assert device.walls_move
    faces = [fluid.walls()["points"] for fluid in (processor, device)]
    np.testing.assert_allclose(*faces, rtol=0.0, atol=1e-12)
    first, second = processor.save(), device.save()
    for key in {"pistons", "pistons_corrected", "damping"} & first.keys():
        assert np.any(first[key] != 0.0)
        assert second[key] == pytest.approx(first[key], rel=1e-8), key
    loaded.load(second)
    device_state, loaded_state = advanced(device, 10).save(), advanced(loaded, 10).save()
    for key, array in device_state.items():
        assert np.array_equal(array, loaded_state[key], equal_nan=True), key


def test_a_fluid_that_a_zone_slows_goes_on_with_the_same_bits():
    """The lists of position Verlet look ahead by the greatest speed: that after damping."""
    zone = {
        "lowest": [-1.0, -1.0, -1.0],
        "highest": [9.0, 9.0, 9.0],
        "towards": "x+",
        "rate": 300.0,
    }
    table = deepcopy(FLUME | TWICE)
    table["boundary"] |= {"damping": [zone]}
    device, other = (DeviceFluid(params_of(table), DEVICE) for _ in range(2))
    for fluid in (device, other):
        fluid.bind({}, frozenset())
    other.load(advanced(device, 30).save())
    whole, resumed = advanced(device, 20).save(), advanced(other, 20).save()
    for key, array in whole.items():
        assert np.array_equal(array, resumed[key], equal_nan=True), key


def test_a_damper_may_begin_from_a_state_without_one():
    begun = advanced(DeviceFluid(params_of(DYNAMIC | TWICE), DEVICE), 5).save()
    damped = params_of(DYNAMIC | TWICE | {"acoustic_damper": 0.05})
    fluids = SphFluid(damped), DeviceFluid(damped, DEVICE)
    for fluid in fluids:
        fluid.begin_from(begun)
    assert difference(*(advanced(fluid, 20) for fluid in fluids), "points") < 1e-12
