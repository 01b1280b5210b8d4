"""Bodies on an OpenCL device are those of the processor, to rounding."""

import subprocess
import sys
from dataclasses import fields

import numpy as np
import pytest
from device_solids import (
    CORRECTED,
    CORRECTED_RINGS,
    DEVICE,
    FAST,
    GLUED,
    HELD,
    PLANAR,
    READ,
    REPELLED,
    RINGS,
    TORN,
    advanced,
    differing,
    params_of,
    require_close,
)

from quintet.components.sph_solid import component
from quintet.components.sph_solid.component import SphSolid
from quintet.components.sph_solid.pair_sums import CurrentSums
from quintet.components.sph_solid.params import SphSolidParams
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import SceneError, StepError

pytest.importorskip("pyopencl")
from quintet.components.shared.opencl.devices import Device, is_accelerator_there
from quintet.components.sph_solid.opencl import stepping
from quintet.components.sph_solid.opencl.device_solid import DeviceSolid


@pytest.mark.parametrize(("table", "steps"), [(FAST, 1000), (CORRECTED, 300), (TORN, 300)])
def test_a_device_computes_as_the_processor_does(table, steps):
    params = params_of(table)
    processor, device = (
        advanced(SphSolid(params), steps),
        advanced(DeviceSolid(params, DEVICE), steps),
    )
    require_close(processor, device)
    assert processor.state.failed.any() and processor.state.strain.max() > 0.0


def test_an_artificial_stress_is_that_of_the_processor():
    params = params_of(REPELLED)
    processor, device = SphSolid(params), DeviceSolid(params, DEVICE)
    assert processor.lists.width == 16 and not processor.lists.are_for_good
    require_close(advanced(processor, 1000), advanced(device, 1000))
    repeated = DeviceSolid(params, Resources(2, device="opencl:0"))
    repeated.load(advanced(DeviceSolid(params, DEVICE), 40).save())
    once = advanced(DeviceSolid(params, DEVICE), 60)
    assert differing(once.save(), advanced(repeated, 20).save()) == []


@pytest.mark.parametrize("table", [PLANAR, HELD])
def test_planes_fixed_particles_and_gravity_are_those_of_the_processor(table):
    params = params_of(table)
    require_close(advanced(SphSolid(params), 150), advanced(DeviceSolid(params, DEVICE), 150))


@pytest.mark.parametrize("table", [RINGS, CORRECTED_RINGS])
def test_rings_are_those_of_the_processor(table):
    params = params_of(table)
    processor, device = advanced(SphSolid(params), 150), advanced(DeviceSolid(params, DEVICE), 150)
    require_close(processor, device)
    assert processor.state.strain.max() > 0.1


@pytest.mark.skipif(is_accelerator_there(), reason="lists by rows are for processors")
@pytest.mark.parametrize("table", [FAST, CORRECTED, RINGS])
def test_lists_by_columns_give_the_bits_of_lists_by_rows(table, monkeypatch):
    monkeypatch.setattr(stepping, "LANES_OF_PROCESSORS", 1)
    params, saved = params_of(table), []
    for is_processor in (True, False):
        monkeypatch.setattr(
            Device, "is_processor", property(lambda self, is_it=is_processor: is_it)
        )
        device = advanced(DeviceSolid(params, DEVICE), 30)
        assert device.stepping.rows.cells.by_rows == is_processor
        saved.append(device.save())
    assert differing(*saved) == []
    require_close(advanced(SphSolid(params), 30), device)


@pytest.mark.parametrize("table", [FAST, CORRECTED])
def test_a_device_repeats_its_bits_on_any_number_of_threads(table):
    params = params_of(table)
    first, second = (
        advanced(DeviceSolid(params, Resources(threads, device="opencl:0")), 60).save()
        for threads in (1, 2)
    )
    assert differing(first, second) == []


def test_snapshots_go_on_elsewhere_and_on_the_device_with_the_same_bits():
    params = params_of(CORRECTED)
    device, processor = DeviceSolid(params, DEVICE), SphSolid(params)
    advanced(device, 50), advanced(processor, 50)
    moved_out, moved_in, moved_on = (
        SphSolid(params),
        DeviceSolid(params, DEVICE),
        DeviceSolid(params, DEVICE),
    )
    moved_out.load(device.save())
    moved_on.load(device.save())
    moved_in.load(processor.save())
    uninterrupted = advanced(processor, 50)
    for solid in (moved_out, moved_in):
        require_close(uninterrupted, advanced(solid, 50))
    assert differing(advanced(device, 50).save(), advanced(moved_on, 50).save()) == []


def test_readings_are_those_of_the_processor():
    params = params_of(FAST | READ)
    processor, device = advanced(SphSolid(params), 70), advanced(DeviceSolid(params, DEVICE), 70)
    names = frozenset(f"{port.name}.{field.name}" for port in device.gives for field in port.fields)
    expected, computed = processor.give(names), device.give(names)
    assert computed.keys() == expected.keys() == names
    for name in names:
        scale = np.abs(expected[name]).max(initial=0.0)
        assert computed[name] == pytest.approx(expected[name], rel=1e-11, abs=1e-11 * scale), name
    assert device.totals().kinetic == pytest.approx(processor.totals().kinetic, rel=1e-12)
    assert device.warnings() == processor.warnings()
    assert device.items() == processor.items() == 128


def pulled(solid, steps, dt=2e-7):
    """Advance a solid whose glued particles are pulled along x, half of them until it is halfway.

    Return the forces on them after each step.
    """
    forces, glued = [], len(solid.describe()["glued_load.mass"])
    half = np.arange(glued) % 2.0
    for number in range(steps):
        velocity = np.zeros((glued, 3))
        velocity[:, 0] = -30.0
        active = np.ones(glued) if number < steps // 2 else half
        solid.take({"glued.velocity": velocity, "glue_activity.active": active})
        solid.step(dt)
        forces.append(solid.give(frozenset({"glued_load.force"}))["glued_load.force"])
    return np.array(forces)


def test_glued_particles_move_and_pull_as_on_the_processor():
    params = params_of(GLUED)
    solids = SphSolid(params), DeviceSolid(params, DEVICE)
    for solid in solids:
        solid.bind({}, frozenset({"glued", "glued_load"}))
    expected, computed = (pulled(solid, 120) for solid in solids)
    largest = np.abs(expected).max()
    assert largest > 0.0 and np.abs(computed - expected).max() < 1e-11 * largest
    require_close(*solids)
    processor, device = solids
    assert device.host.state.work == pytest.approx(processor.state.work, rel=1e-11)
    restarted = DeviceSolid(params, DEVICE)
    restarted.bind({}, frozenset({"glued", "glued_load"}))
    restarted.load(device.save())
    for solid in (device, restarted):
        pulled(solid, 20)
    assert differing(device.save(), restarted.save()) == []


@pytest.mark.parametrize("steps", [0, 3])
def test_a_step_that_fails_names_its_particle(steps):
    params = params_of(FAST)
    messages = []
    for solid in (SphSolid(params), DeviceSolid(params, DEVICE)):
        advanced(solid, steps)
        with pytest.raises(StepError, match="in a step particles must stay finite") as error:
            for _ in range(50):
                solid.step(1e-4)
        messages.append(str(error.value))
    assert messages[0] == messages[1]


# A new key stands here once it was tried on a device, or else is refused there.
TRIED = frozenset(
    """spacing bodies dimensions axisymmetric smoothing symmetry fixed glued contact_with_faces
    gravity gauges levels courant viscosity_linear viscosity_quadratic kernel_correction
    artificial_stress total_lagrangian""".split()
)


def test_every_key_of_the_bodies_was_tried_on_a_device():
    assert {field.name for field in fields(SphSolidParams)} == TRIED


def test_what_is_not_finite_is_found_on_the_device():
    device = advanced(DeviceSolid(params_of(FAST), DEVICE), 2)
    device.check()
    saved = device.save()
    saved["damage"][5] = np.nan
    device.load(saved)
    device.step(device.stable_dt())
    with pytest.raises(StepError, match="damage"):
        device.check()


def test_host_parts_without_a_key_are_refused(monkeypatch):
    class OtherSums(CurrentSums):
        pass

    monkeypatch.setattr(
        component, "pair_sums", lambda params, team: OtherSums(lambda *_: None, team)
    )
    monkeypatch.setattr(SphSolid, "_begin", lambda self: None)
    with pytest.raises(SceneError, match=r"on device opencl, .* found OtherSums\. Set device"):
        DeviceSolid(params_of(FAST), DEVICE)


def test_a_device_without_double_precision_is_refused(monkeypatch):
    monkeypatch.setattr(Device, "has_doubles", property(lambda self: False))
    with pytest.raises(SceneError, match=r"it must compute in double precision.*`quintet devices`"):
        DeviceSolid(params_of(FAST), DEVICE)


def test_bodies_on_the_processor_load_no_opencl():
    program = (
        "import sys; from quintet.components.sph_solid import MANIFEST; MANIFEST.load();"
        "print([name for name in sys.modules if 'opencl' in name])"
    )
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert result.stdout.strip() == "[]", result.stderr
