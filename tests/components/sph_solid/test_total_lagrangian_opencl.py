"""Bodies with the neighbours of the start on a device: as on the processor, in contact too."""

import subprocess
import sys

import numpy as np
import pytest
from device_solids import (
    DEVICE,
    JOINED,
    MEETING,
    YIELDING,
    advanced,
    differing,
    params_of,
    require_close,
)

from quintet.components.sph_solid.component import SphSolid
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import StepError

pytest.importorskip("pyopencl")
from quintet.components.shared.opencl.devices import Device, is_accelerator_there
from quintet.components.sph_solid.opencl import stepping, touching
from quintet.components.sph_solid.opencl.device_solid import DeviceSolid


def touched(solid):
    """Pairs that a solid on the processor has in contact now."""
    state, contact = solid.state, solid.sums.touching
    contact.energy(state, np.ones(state.particles), np.ones(state.particles))
    i, j = contact.pairs.T
    apart = np.linalg.norm(state.position[i] - state.position[j], axis=1)
    return int((apart < contact.spacing).sum())


@pytest.mark.parametrize(("table", "steps"), [(MEETING, 1000), (JOINED, 200), (YIELDING, 200)])
def test_bodies_that_keep_their_neighbours_move_as_on_the_processor(table, steps):
    params, contacts = params_of(table), 0
    processor, device = SphSolid(params), DeviceSolid(params, DEVICE)
    assert processor.lists.are_for_good
    for part in (10, 10, 20, steps - 40):
        advanced(processor, part), advanced(device, part)
        contacts += touched(processor)
    require_close(processor, device)
    assert contacts > 0


def test_a_plane_pushes_particles_off_on_a_device():
    params = params_of(MEETING)
    device, nearest = DeviceSolid(params, DEVICE), np.inf
    _, (plane, rows) = device.host.sums.touching.planes
    for _ in range(15):
        advanced(device, 10)
        apart = 2.0 * (device.save()["position"][rows, plane.axis] - plane.position)
        nearest = min(nearest, apart.min())
    assert 0.5 * params.spacing < nearest < params.spacing


@pytest.mark.skipif(is_accelerator_there(), reason="lists by rows are for processors")
def test_lists_of_contact_by_columns_give_the_bits_of_lists_by_rows(monkeypatch):
    monkeypatch.setattr(stepping, "LANES_OF_PROCESSORS", 1)
    monkeypatch.setattr(touching, "FEWEST", 1)  # too short at first
    params, saved = params_of(MEETING), []
    for is_processor in (True, False):
        monkeypatch.setattr(
            Device, "is_processor", property(lambda self, is_it=is_processor: is_it)
        )
        saved.append(advanced(DeviceSolid(params, DEVICE), 40).save())
    assert differing(*saved) == []


def test_threads_and_snapshots_do_not_change_bits_of_bodies_in_contact():
    params = params_of(JOINED)
    first, second = (
        advanced(DeviceSolid(params, Resources(threads, device="opencl:0")), 40)
        for threads in (1, 2)
    )
    assert differing(first.save(), second.save()) == []
    moved = DeviceSolid(params, DEVICE)
    moved.load(first.save())  # lists of contact are made elsewhere
    for solid in (first, moved):
        advanced(solid, 40)
    assert differing(first.save(), moved.save()) == []


def test_snapshots_of_kept_neighbours_go_on_elsewhere():
    params = params_of(MEETING)
    processor, device = advanced(SphSolid(params), 20), DeviceSolid(params, DEVICE)
    device.load(processor.save())
    back = SphSolid(params)
    back.load(advanced(device, 20).save())
    require_close(advanced(processor, 40), advanced(back, 20))


def test_a_failed_step_of_kept_neighbours_names_its_particle():
    device = advanced(DeviceSolid(params_of(YIELDING), DEVICE), 2)
    with pytest.raises(StepError, match=r"particles must stay finite .*; particle \d+ of body"):
        for _ in range(50):
            device.step(1e-3)


def test_scenes_whose_neighbours_change_do_not_load_those_that_keep_them():
    program = (
        "import sys; from device_solids import FAST, DEVICE, params_of;"
        "from quintet.components.sph_solid.opencl.device_solid import DeviceSolid;"
        "DeviceSolid(params_of(FAST), DEVICE);"
        "print([name for name in sys.modules if 'reference' in name and 'sph_solid' in name])"
    )
    result = subprocess.run(
        [sys.executable, "-c", program],
        capture_output=True,
        text=True,
        cwd=__file__.rpartition("/")[0],
    )
    assert result.stdout.strip() == "[]", result.stderr
