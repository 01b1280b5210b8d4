"""Bodies in a fluid on an OpenCL device move and are pushed as on the processor."""

import numpy as np
import pytest
from device_bodies import (
    DEVICE,
    DYNAMIC,
    JOINED,
    MIRRORED,
    SPEED,
    START,
    Cube,
    around,
    join_cube,
    pair,
    params_of,
    require_close,
)  # fmt: skip

from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import OrderError

pytest.importorskip("pyopencl")
from quintet.components.shared.opencl.devices import Device
from quintet.components.sph_fluid.opencl.device_fluid import DeviceFluid

LOW = np.array([0.25, 0.25, 0.12])  # m, with a narrow gap below it
FILMS = MIRRORED | {"boundary__lubrication_films": True}


CASES = [
    (MIRRORED, START, 1.0),
    (DYNAMIC, START, 1.0),
    (MIRRORED | {"kernel": "quintic"}, START, 0.8),
    (FILMS, LOW, 1.0),
    (FILMS | {"boundary__lubrication_films": "auto"}, LOW, 1.0),
    (FILMS | {"integration": "symplectic"}, LOW, 1.0),
    (MIRRORED | {"viscosity__kinematic": 0.05}, START, 1.0),
]


@pytest.mark.parametrize(("changes", "start", "share"), CASES)
def test_a_body_is_pushed_as_on_the_processor(changes, start, share):
    (processor, first), (device, second) = pair(changes, start, share)
    expected, computed = first.push(processor, 80), second.push(device, 80)
    assert np.abs(computed - expected).max() < 1e-9 * np.abs(expected).max()
    require_close(processor, device)
    assert (processor.state.film != 0.0).any() == ("lubrication_films" in str(changes))
    assert processor.state.moved < 80 * 4e-4 * np.linalg.norm(SPEED)  # lists were made again


def test_a_device_that_is_no_processor_pushes_bodies_too(monkeypatch):
    monkeypatch.setattr(Device, "is_processor", property(lambda self: False))
    (processor, first), (device, second) = pair(MIRRORED, share=0.8)
    expected, computed = first.push(processor, 30), second.push(device, 30)
    assert np.abs(computed - expected).max() < 1e-9 * np.abs(expected).max()


@pytest.mark.parametrize("changes", [MIRRORED, DYNAMIC])
def test_bodies_gain_the_momentum_that_the_fluid_loses(changes):
    no_weight = {"boundary__walls": None, "gravity": [0.0, 0.0, 0.0]}
    params, cube = around(**(changes | no_weight)), Cube()
    device = join_cube(DeviceFluid(params, DEVICE), cube)
    cube.push(device, 5)
    before, dt = device.totals().momentum, 4e-4
    impulse = dt * cube.push(device, 20, dt).sum(axis=(0, 1))
    gained = device.totals().momentum - before
    assert np.abs(impulse).max() > 1e-3
    assert np.abs(impulse + gained).max() < 1e-13 * np.abs(before).max()


def test_bodies_are_pushed_with_the_same_bits_on_any_number_of_threads():
    params, results = around(**FILMS), []
    for threads in (1, 2):
        cube = Cube()
        fluid = join_cube(DeviceFluid(params, Resources(threads, device="opencl:0")), cube)
        cube.push(fluid, 30)
        results.append(fluid.save())
    for key, array in results[0].items():
        assert np.array_equal(array, results[1][key], equal_nan=True), key


def test_snapshots_of_fluids_with_bodies_go_on_elsewhere():
    fluids = pair(FILMS, LOW)
    (processor, cube), (device, _) = fluids
    for fluid, pushed_cube in fluids:
        pushed_cube.push(fluid, 25)
    params = around(LOW, **FILMS)
    restarts = {}
    for name, restarted, source in (
        ("out", SphFluid(params), device),
        ("in", DeviceFluid(params, DEVICE), processor),
        ("on", DeviceFluid(params, DEVICE), device),
    ):
        restarted_cube = Cube(start=LOW)
        restarts[name] = join_cube(restarted, restarted_cube)
        restarted.load(source.save())
        restarted_cube.place = cube.place.copy()
        restarted_cube.push(restarted, 25)
    for fluid, pushed_cube in fluids:
        pushed_cube.push(fluid, 25)
    require_close(processor, restarts["out"])
    require_close(processor, restarts["in"])
    first, second = device.save(), restarts["on"].save()
    for key, array in first.items():
        assert np.array_equal(array, second[key], equal_nan=True), key


def test_fluid_inside_a_body_is_removed():
    params = params_of(remove_inside_bodies=True, **MIRRORED)
    forces = []
    for fluid in (SphFluid(params), DeviceFluid(params, DEVICE)):
        cube = Cube()
        fluid.bind(cube.static, JOINED)
        fluid.prime(cube.fields())
        forces.append(cube.push(fluid, 10))
    assert np.abs(forces[1] - forces[0]).max() < 1e-9 * np.abs(forces[0]).max()


def test_single_precision_rounds_forces_on_bodies():
    exact, cube = pair(MIRRORED)[0]
    rounded, rounded_cube = pair(MIRRORED | {"precision": "float32"})[1]
    expected, computed = cube.push(exact, 20), rounded_cube.push(rounded, 20)
    assert 0.0 < np.abs(computed - expected).max() < 1e-3 * np.abs(expected).max()


def test_samples_must_be_placed_before_a_step():
    fluid = DeviceFluid(around(**DYNAMIC), DEVICE)
    fluid.bind(Cube().static, JOINED)
    with pytest.raises(OrderError, match=r"samples must be placed first"):
        fluid.step(1e-4)
