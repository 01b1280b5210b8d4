"""Fluid enters and leaves on an OpenCL device as on the processor."""

import numpy as np
import pytest
from device_bodies import DEPTH, JOINED, MIRRORED, WIDTH, Cube, require_close
from device_bodies import params_of as body_params
from device_fluids import DEVICE, advanced, difference
from tubes import TUBE, params_of

from quintet.components.sph_fluid import MANIFEST
from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.component import Resources, outputs_of
from quintet.interfaces.errors import SceneError

pytest.importorskip("pyopencl")
from quintet.components.shared.opencl.devices import Device
from quintet.components.sph_fluid.opencl.device_fluid import DeviceFluid

PROFILE = [{"face": "x-", "speed": "1.5 * z * (1 - z) + 0.4"}]
WALLED = {
    "boundary.method": "mdbc",
    "kernel": "wendland",
    "viscosity.kinematic": 0.02,
    "boundary.inflow": PROFILE,
}
ZONE = {"lowest": [0.1, 0.0, 0.0], "highest": [2.0, 1.0, 0.5], "towards": "x+", "rate": 0.5}
CASES = [
    WALLED | {"boundary.wall_viscosity_factor": 1.0},
    {
        "boundary.outflow": [{"face": "x+", "pressure": 20.0}],
        "boundary.damping": [ZONE],
        "shepard_every": 7,
        "xsph": 0.2,
    },
    WALLED | {"integration": "symplectic", "acoustic_damper": 0.3},
]


@pytest.mark.parametrize("changes", CASES)
def test_fluid_comes_and_goes_as_on_the_processor(changes):
    params = params_of(TUBE, **changes)
    processor, device = SphFluid(params), DeviceFluid(params, DEVICE)
    assert device.items_vary
    for fluid in (processor, device):
        advanced(fluid, 200)
    first, second = processor.save(), device.save()
    assert first["passed"].min() > 0
    for key in ("identity", "role", "passed", "born", "returned", "lost_through", "exit_face"):
        assert np.array_equal(first[key], second[key]), key
    assert second["carried"] == pytest.approx(first["carried"], rel=1e-12)
    assert difference(processor, device, "points") < 1e-13
    assert difference(processor, device, "density") < 1e-12
    expected, computed = outputs_of(processor), outputs_of(device)
    for name, reading in expected.items():
        assert computed[name] == pytest.approx(reading, rel=1e-10, abs=1e-10), name
    assert computed["mass_gauge.imbalance"] == 0.0
    totals = device.totals()
    assert sum(totals.mass_balance.values()) == pytest.approx(totals.mass, rel=1e-13)
    assert device.items() == processor.items()


def test_rows_sorted_on_the_host_have_the_bits_of_those_sorted_on_the_device(monkeypatch):
    params = params_of(TUBE)
    device, through_host = DeviceFluid(params, DEVICE), DeviceFluid(params, DEVICE)
    rows = through_host.stepping.rows
    surveyed = rows.survey
    monkeypatch.setattr(rows, "survey", lambda: (*surveyed()[:3], True))  # outside of the tank
    first, second = advanced(device, 100).save(), advanced(through_host, 100).save()
    assert first["passed"].min() > 0
    for key, array in first.items():
        assert np.array_equal(array, second[key], equal_nan=True), key


def test_room_for_pairs_is_made_again_only_where_fluid_came_or_went():
    device = advanced(DeviceFluid(params_of(TUBE), DEVICE), 60)
    stepping, state = device.stepping, device.host.state
    stepping.renew(state)  # what is due has now come and gone
    count, rate = state.fluid, stepping.passes.rate
    assert stepping.renew(state)  # rows were written
    assert state.fluid == count
    assert stepping.passes.rate is rate


@pytest.mark.parametrize("changes", [{}, {"integration": "symplectic"}])
def test_threads_and_a_saved_state_change_no_bit(changes):
    params = params_of(TUBE, **changes)
    device, shared, loaded = (
        DeviceFluid(params, Resources(threads, device="opencl:0")) for threads in (1, 2, 1)
    )
    saved = advanced(device, 60).save()
    loaded.load(saved)
    advanced(shared, 60)
    first, *others = (advanced(fluid, 60).save() for fluid in (device, shared, loaded))
    assert first["born"] > saved["born"]
    for second in others:
        for key, array in first.items():
            assert np.array_equal(array, second[key], equal_nan=True), key


def test_snapshots_go_on_elsewhere():
    params = params_of(TUBE)
    processor, device = advanced(SphFluid(params), 60), advanced(DeviceFluid(params, DEVICE), 60)
    moved_out, moved_in = SphFluid(params), DeviceFluid(params, DEVICE)
    moved_out.load(device.save())
    moved_in.load(processor.save())
    advanced(processor, 60)
    for fluid in (moved_out, moved_in):
        advanced(fluid, 60)
        assert np.array_equal(fluid.save()["identity"], processor.save()["identity"])
        assert difference(processor, fluid, "points") < 1e-13


def test_a_device_that_is_no_processor_lets_fluid_enter_too(monkeypatch):
    monkeypatch.setattr(Device, "is_processor", property(lambda self: False))
    params = params_of(TUBE)
    processor, device = advanced(SphFluid(params), 60), advanced(DeviceFluid(params, DEVICE), 60)
    assert processor.save()["passed"].min() > 0
    assert difference(processor, device, "points") < 1e-13


def test_a_body_in_a_flow_is_pushed_as_on_the_processor():
    """Rows of samples stand behind the fluid, whose number changes."""
    params = body_params(
        **MIRRORED,
        remove_inside_bodies=True,
        fluid=(((0.0, 0.0, 0.0), (1.2, WIDTH, DEPTH)),),
        initial__velocity=[1.0, 0.0, 0.0],
        boundary__walls=((0.0, 0.0, 0.0), (1.2, WIDTH, DEPTH)),
        boundary__open_faces=["x-", "x+"],
        boundary__inflow=[{"face": "x-", "speed": 1.0}],
        boundary__outflow=[{"face": "x+"}],
    )
    fluids, forces = (SphFluid(params), DeviceFluid(params, DEVICE)), []
    for fluid in fluids:
        cube = Cube(start=np.array([0.6, 0.25, 0.2]), speed=np.array([0.3, 0.0, 0.0]))
        fluid.bind(cube.static, JOINED)
        fluid.prime(cube.fields())
        forces.append(cube.push(fluid, 80))
    processor, device = fluids
    assert processor.save()["passed"].min() > 0
    assert np.abs(forces[1] - forces[0]).max() < 1e-9 * np.abs(forces[0]).max()
    require_close(processor, device)


def test_inflows_are_refused_on_several_devices():
    with pytest.raises(SceneError, match=r"inflow must be empty of a fluid on 2 ranks; found 1"):
        MANIFEST.check_device(params_of(TUBE), "opencl", 2)
