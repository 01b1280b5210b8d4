"""A gas on an OpenCL device is the gas of the processor, to rounding."""

import subprocess
import sys
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest
from device_gases import (
    DEVICE,
    FROM_REST,
    IN_SPACE,
    SPHERE,
    STREAM,
    SUPERSONIC,
    VISCOUS,
    advanced,
    apart,
    both,
    params_of,
    same_bits,
)

from quintet.components.meshless_gas.boundaries import Boundary
from quintet.components.meshless_gas.component import MeshlessGas
from quintet.components.meshless_gas.conform import cases
from quintet.components.meshless_gas.laws.limiters import LAWS, limiter_of
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import SceneError, StepError

pytest.importorskip("pyopencl")
from quintet.components.meshless_gas.opencl.device_gas import DeviceGas
from quintet.components.meshless_gas.opencl.features import MAKERS
from quintet.components.meshless_gas.opencl.friction import DeviceFriction
from quintet.components.meshless_gas.opencl.programs import Physics, gas_program
from quintet.components.shared.opencl.devices import Device

NIGHTLY = pytest.mark.full  # programs of their own


@pytest.mark.parametrize(
    ("table", "steps"),
    [
        (STREAM, 1000),
        (FROM_REST, 60),
        (SUPERSONIC, 60),
        pytest.param(STREAM | {"order": 1}, 60, marks=NIGHTLY),
        pytest.param(IN_SPACE, 60, marks=NIGHTLY),
        pytest.param(IN_SPACE | {"viscous": True}, 60, marks=NIGHTLY),
        pytest.param(SPHERE, 60, marks=NIGHTLY),
        *(pytest.param(STREAM | {"limiter": name}, 60, marks=NIGHTLY) for name in LAWS),
    ],
)
def test_a_device_computes_as_the_processor_does(table, steps):
    processor, device = both(DeviceGas, table, steps)
    first, second = processor.save(), device.save()
    assert first.keys() == second.keys()
    assert first["time"] > 0.0 and np.any(first["entered"])
    for key in ("conservative", "primitive", "entered", "time", "work", "begun"):
        assert apart(first[key], second[key]) < 1e-12, key
    assert device.stable_dt() == pytest.approx(processor.stable_dt(), rel=1e-12)


def test_a_device_that_is_no_processor_gets_tables_by_columns_and_single_lanes(monkeypatch):
    monkeypatch.setattr(Device, "is_processor", property(lambda self: False))
    processor, device = both(DeviceGas, SUPERSONIC, 30)
    assert not device.stepping.state.tables.by_rows and device.stepping.state.lanes == 1
    assert apart(processor.save()["conservative"], device.save()["conservative"]) < 1e-13


@pytest.mark.parametrize("is_processor", [True, pytest.param(False, marks=NIGHTLY)])
def test_walls_hold_and_heat_a_gas_with_friction_as_on_the_processor(is_processor, monkeypatch):
    if not is_processor:
        monkeypatch.setattr(Device, "is_processor", property(lambda self: False))
    processor, device = both(DeviceGas, VISCOUS, 100)
    first, second = processor.save(), device.save()
    for key in ("conservative", "entered", "work"):
        assert apart(first[key], second[key]) < 1e-12, key
    names = frozenset({"wall.friction", "wall.heat_flux", "wall.pressure", "body.force"})
    expected, computed = processor.give(names), device.give(names)
    for name in names:
        assert np.any(expected[name]) and apart(expected[name], computed[name]) < 1e-11, name
    params = params_of(VISCOUS)
    loaded = DeviceGas(params, DEVICE)
    loaded.load(second)
    same_bits(advanced(device, 10).save(), advanced(loaded, 10).save())


def test_point_particles_and_gas_push_and_heat_each_other_as_on_the_processor():
    (case,) = (case for case in cases() if case.name == "particles in a gas")
    params, gases = params_of(case.params), []
    warm = case.rest | {"particles.temperature": np.full(2, 400.0)}
    warm["particles.velocity"] = np.array([[30.0, 0.0, 5.0], [0.0, 0.0, -20.0]])
    loaded = DeviceGas(params, DEVICE)
    for gas in (MeshlessGas(params), DeviceGas(params, DEVICE), loaded):
        gas.bind(case.static, frozenset(case.static))
        gas.prime(warm)
        gas.take(warm)
        gases.append(gas if gas is loaded else advanced(gas, 40))
    processor, device, _ = gases
    first, second = processor.save(), device.save()
    assert first.keys() == second.keys()
    for key in ("conservative", "entered", "particles.force", "particles.heat"):
        assert np.any(first[key]) and apart(first[key], second[key]) < 1e-11, key
    loaded.load(second)
    same_bits(advanced(device, 5).save(), advanced(loaded, 5).save())


def test_gauges_totals_and_views_are_those_of_the_processor():
    processor, device = both(DeviceGas, STREAM, 40)
    names = frozenset(f"{p.name}.{f.name}" for p in device.gives for f in p.fields)
    expected, computed = processor.give(names), device.give(names)
    assert computed.keys() == expected.keys() == names and "probes.pressure" in names
    for name in names - {"balance.mass_drift", "balance.energy_drift", "balance.momentum_drift"}:
        assert computed[name] == pytest.approx(expected[name], rel=1e-9, abs=1e-12), name
    assert device.totals().kinetic == pytest.approx(processor.totals().kinetic, rel=1e-12)
    assert apart(processor.view()["schlieren"], device.view()["schlieren"]) < 1e-9
    assert device.items() == processor.items()


def test_the_same_device_gives_the_same_bits_on_any_number_of_threads():
    params = params_of(STREAM)
    first, second = (
        advanced(DeviceGas(params, Resources(threads, device="opencl:0")), 30).save()
        for threads in (1, 2)
    )
    same_bits(first, second)


SETTLING = {"steady": {"steps": 10, "change": 1e-9}, "local_steps": True}


def test_nodes_take_steps_of_their_own_and_settle_as_on_the_processor():
    table = STREAM | SETTLING | {"steady": {"steps": 10, "change": 2e-3, "force": 1.0}}
    processor, device = both(DeviceGas, table, 400)
    assert processor.monitor.is_settled and device.host.monitor.is_settled
    first, second = processor.save(), device.save()
    for key in ("conservative", "settling", "settling_marks", "change"):
        assert apart(first[key], second[key]) < 1e-10, key


def test_a_snapshot_of_a_device_goes_on_there_with_the_same_bits():
    params = params_of(STREAM | SETTLING)
    device, loaded = advanced(DeviceGas(params, DEVICE), 25), DeviceGas(params, DEVICE)
    loaded.load(device.save())
    same_bits(advanced(device, 25).save(), advanced(loaded, 25).save())


def test_snapshots_go_on_elsewhere():
    params = params_of(STREAM)
    processor, device = both(DeviceGas, STREAM, 25)
    moved_out, moved_in = MeshlessGas(params), DeviceGas(params, DEVICE)
    moved_out.load(device.save())
    moved_in.load(processor.save())
    uninterrupted = advanced(processor, 25).save()["conservative"]
    for gas in (moved_out, moved_in):
        assert apart(uninterrupted, advanced(gas, 25).save()["conservative"]) < 1e-13


def test_a_step_that_fails_does_so_as_on_the_processor():
    params, messages = params_of(STREAM | {"courant": 9.0}), []
    for gas in (MeshlessGas(params), DeviceGas(params, DEVICE)):
        with pytest.raises(StepError, match="density and pressure must stay above 0") as error:
            advanced(gas, 60)
        messages.append(str(error.value))
    assert messages[0] == messages[1]


COMPUTED = frozenset(
    """gas dimensions axisymmetric box sphere plate initial zones riemann vortex neighbours order
    limiter limiter_threshold courant viscous local_steps steady probes fronts particles moving
    boundaries.kind boundaries.state boundaries.total boundaries.pressure boundaries.velocity
    boundaries.temperature boundaries.accommodation""".split()
)


def test_devices_compute_every_key_of_a_gas():
    # Write a new key into the list once a device computes what it asks for.
    keys = {field.name for field in fields(MeshlessGasParams)} - {"boundaries"}
    keys |= {f"boundaries.{field.name}" for field in fields(Boundary)}
    assert keys == COMPUTED


def test_host_parts_that_no_device_computes_are_refused(monkeypatch):
    monkeypatch.delitem(MAKERS, "Viscous")
    with pytest.raises(SceneError, match=r"on device opencl, .* found Viscous\. Set"):
        DeviceGas(params_of(VISCOUS), DEVICE)


def test_a_device_without_double_precision_is_refused(monkeypatch):
    monkeypatch.setattr(Device, "has_doubles", property(lambda self: False))
    with pytest.raises(SceneError, match=r"it must compute in double precision.*`quintet devices`"):
        DeviceGas(params_of(STREAM), DEVICE)


def test_a_device_that_is_not_there_is_refused():
    with pytest.raises(SceneError, match=r"device opencl:99: .*found 1.*`quintet devices`"):
        DeviceGas(params_of(STREAM), Resources(device="opencl:99"))


def test_a_gas_on_the_processor_loads_no_opencl():
    program = (
        "import sys; from quintet.components.meshless_gas import MANIFEST; MANIFEST.load();"
        "print([name for name in sys.modules if 'opencl' in name])"
    )
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert result.stdout.strip() == "[]", result.stderr


def test_a_gas_on_a_device_loads_nothing_that_its_scene_leaves_out():
    program = (
        "import sys; from device_gases import DEVICE, STREAM, params_of;"
        "from quintet.components.meshless_gas.opencl.device_gas import DeviceGas;"
        "DeviceGas(params_of(STREAM), DEVICE); begin = 'quintet.components.meshless_gas.';"
        "print(sorted(name.removeprefix(begin) for name in sys.modules if name.startswith(begin)))"
    )
    result = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, cwd=Path(__file__).parent
    )
    assert "'opencl.stepping'" in result.stdout, result.stderr
    left_out = ("moving.", "axis", "viscous", "ranks.several", "opencl.bodies", "opencl.ranks")
    for name in (*left_out, "opencl.axis", "opencl.friction", "opencl.sliding"):
        assert f"'{name}" not in result.stdout, name


def test_a_rank_writes_the_walls_of_its_share_alone():
    device = DeviceGas(params_of(VISCOUS), DEVICE)
    friction, stepping = device.host.friction, device.stepping
    before = stepping.state.tables.get(stepping.state.primitive)
    disturbed = before * np.linspace(1.0, 1.2, len(before))[:, np.newaxis]
    stepping.state.tables.put(stepping.state.primitive, disturbed)
    friction.written = slice(3, 7)  # as on one of several ranks
    DeviceFriction(friction, stepping.state).write_walls()
    after = stepping.state.tables.get(stepping.state.primitive)
    changed = np.flatnonzero((after != disturbed).any(axis=1))
    assert np.array_equal(changed, friction.rows[3:7])


def test_a_rank_computes_gradients_where_it_needs_them_alone(monkeypatch):
    device = DeviceGas(params_of(VISCOUS), DEVICE)
    stepping, domain, rows = device.stepping, device.host.motion.domain, {}
    stepping.cloud.put_rows(domain._replace(every=domain.every[:40]))  # as on one of several ranks
    run = stepping.state.run

    def noted_run(name, count, *arguments):
        rows[name] = count
        run(name, count, *arguments)

    for part in (stepping, stepping.state):
        monkeypatch.setattr(part, "run", noted_run)
    device.step(1e-6)
    assert rows["write_gradients"] == rows["write_temperature_slopes"] == 40
    assert rows["write_bounds"] == len(domain.inner)


def test_a_gas_without_friction_prints_no_laws_of_it():
    inviscid, viscous = (
        gas_program(limiter_of("koren", None), Physics(True, True, has_friction), 1, False)
        for has_friction in (False, True)
    )
    assert "sutherland" not in inviscid and "sutherland" in viscous
    for program in (inviscid, viscous):
        left_out = ("#define MOVING", "slip_wall_state", "#define RAREFIED", "velocity_at_wall")
        assert not any(text in program for text in left_out)
