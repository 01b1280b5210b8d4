"""The contact potential pushes on an OpenCL device as on the processor."""

import numpy as np
import pytest
from device_bodies import DEVICE, JOINED, MIRRORED, Cube, around, pair, require_close

from quintet.components.sph_fluid.component import SphFluid

pytest.importorskip("pyopencl")
from quintet.components.sph_fluid.opencl.device_fluid import DeviceFluid

POTENTIAL = {"boundary__method": "potential"}


def require_alike(processor, device, cube, other_cube, steps=60):
    expected, computed = cube.push(processor, steps), other_cube.push(device, steps)
    assert np.abs(expected).max() > 0.0
    assert np.abs(computed - expected).max() < 1e-9 * np.abs(expected).max()
    require_close(processor, device)
    assert processor.state.moved < steps * 4e-4 * 0.4  # lists were made again
    assert device.stable_dt() == pytest.approx(processor.stable_dt(), rel=1e-11)
    stored, computed = processor.totals().internal, device.totals().internal
    assert computed == pytest.approx(stored, rel=1e-9)


@pytest.mark.parametrize(
    "changes",
    [
        {},
        pytest.param(
            {"boundary__potential_exponent": 4, "kernel": "wendland"}, marks=pytest.mark.full
        ),
    ],
)
def test_walls_and_bodies_push_by_the_contact_potential(changes):
    (processor, cube), (device, other_cube) = pair(POTENTIAL | changes)
    require_alike(processor, device, cube, other_cube)
    lists = device.stepping.rows.lists
    assert lists.end.shape[0] == device.host.state.fluid + len(cube.arm)  # walls have none


@pytest.mark.parametrize("changes", [{}, {"acoustic_damper": 0.5, "integration": "symplectic"}])
def test_links_choose_the_potential_for_the_samples_that_they_bring(changes):
    params, fluids = around(**MIRRORED, **changes), []
    for fluid in (SphFluid(params), DeviceFluid(params, DEVICE)):
        cube = Cube()
        contact = np.zeros(len(cube.arm))
        contact[::2] = 1.0  # one of two samples of the same body
        fluid.bind(cube.static | {"surface.contact": contact}, JOINED)
        fluid.take(cube.fields())
        fluids.append((fluid, cube))
    (processor, cube), (device, other_cube) = fluids
    require_alike(processor, device, cube, other_cube)
    assert processor.boundary.mask.sum() == (len(cube.arm) + 1) // 2


def test_snapshots_with_the_potential_go_on_elsewhere():
    fluids = pair(POTENTIAL)
    for fluid, cube in fluids:
        cube.push(fluid, 20)
    (processor, cube), (device, _) = fluids
    restarts = []
    for restarted, source in (
        (SphFluid(processor.params), device),
        (DeviceFluid(processor.params, DEVICE), processor),
        (DeviceFluid(processor.params, DEVICE), device),
    ):
        restarted_cube = Cube()
        restarted.bind(cube.static, JOINED)
        restarted.load(source.save())
        restarted_cube.place = cube.place.copy()
        restarted_cube.push(restarted, 20)
        restarts.append(restarted)
    for fluid, pushed_cube in fluids:
        pushed_cube.push(fluid, 20)
    for restarted in restarts[:2]:
        require_close(processor, restarted)
    first, second = device.save(), restarts[2].save()
    for key, array in first.items():
        assert np.array_equal(array, second[key], equal_nan=True), key


def test_single_precision_rounds_the_potential():
    exact, cube = pair(POTENTIAL)[0]
    rounded, rounded_cube = pair(POTENTIAL | {"precision": "float32"})[1]
    expected, computed = cube.push(exact, 20), rounded_cube.push(rounded, 20)
    assert 0.0 < np.abs(computed - expected).max() < 1e-3 * np.abs(expected).max()
