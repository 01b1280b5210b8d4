"""Bodies with clouds of their own in a gas on an OpenCL device, as on the processor."""

import numpy as np
import pytest
from device_gases import DEVICE, advanced, apart, params_of, same_bits
from moving_gases import IN_PLANE, ON_AXIS, STICKING, THROUGH_SPACE

from quintet.components.meshless_gas.component import MeshlessGas
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import StepError

pytest.importorskip("pyopencl")
from quintet.components.meshless_gas.opencl.device_gas import DeviceGas
from quintet.components.shared.opencl.devices import Device

NIGHTLY = pytest.mark.full  # programs of their own


def together(table, steps):
    """The same gas on the processor and on a device, after steps of the same length.

    Nodes of a ring lie at the same distance from another but for rounding: if bodies were apart by
    rounding, other neighbours would be taken.
    """
    params = params_of(table)
    processor, device = MeshlessGas(params), DeviceGas(params, DEVICE)
    for _ in range(steps):
        step = processor.stable_dt()
        processor.step(step)
        device.step(step)
    return processor, device


def outputs(gas):
    return gas.give(frozenset(f"{port.name}.{field.name}" for port in gas.gives
                              for field in port.fields if port.name != "balance"))  # fmt: skip


@pytest.mark.parametrize(
    ("table", "steps"),
    [
        (IN_PLANE, 25),
        (STICKING, 20),
        pytest.param(ON_AXIS, 40, marks=NIGHTLY),
        pytest.param(THROUGH_SPACE, 12, marks=NIGHTLY),
    ],
)
def test_bodies_move_through_a_gas_on_a_device_as_on_the_processor(table, steps):
    processor, device = together(table, steps)
    first, second = processor.save(), device.save()
    assert first.keys() == second.keys()
    assert first["moving/fresh_count"] == second["moving/fresh_count"]
    for key in ("conservative", "entered", "work", "moving/summed"):
        assert np.any(first[key]) and apart(first[key], second[key]) < 1e-12, key
    for key in ("moving/centre", "moving/neighbours", "moving/coefficients", "moving/volumes"):
        assert np.array_equal(first[key], second[key]), key
    expected, computed = outputs(processor), outputs(device)
    for key, array in expected.items():
        assert np.allclose(computed[key], array, rtol=1e-10, atol=1e-12), key
    assert device.stable_dt() == pytest.approx(processor.stable_dt(), rel=1e-12)


def test_holes_are_cut_again_and_nodes_come_back_on_a_device():
    _, device = together(IN_PLANE, 25)
    assert device.save()["moving/fresh_count"] > 10
    assert len(device.view()["points"]) < device.items()  # some nodes are left out


def test_a_device_that_is_no_processor_has_the_clouds_of_bodies_by_columns(monkeypatch):
    monkeypatch.setattr(Device, "is_processor", property(lambda self: False))
    processor, device = together(IN_PLANE, 12)
    assert not device.stepping.state.tables.by_rows
    assert apart(processor.save()["conservative"], device.save()["conservative"]) < 1e-13


def test_bodies_on_a_device_have_the_same_bits_on_any_number_of_threads():
    params = params_of(IN_PLANE)
    first, second = (
        advanced(DeviceGas(params, Resources(threads, device="opencl:0")), 20).save()
        for threads in (1, 2)
    )
    same_bits(first, second)


@pytest.mark.parametrize("table", [IN_PLANE, pytest.param(STICKING, marks=NIGHTLY)])
def test_a_snapshot_of_bodies_on_a_device_goes_on_with_the_same_bits(table):
    params = params_of(table)
    device, loaded = advanced(DeviceGas(params, DEVICE), 7), DeviceGas(params, DEVICE)
    loaded.load(device.save())
    same_bits(advanced(device, 8).save(), advanced(loaded, 8).save())


def test_snapshots_of_bodies_go_on_elsewhere():
    params = params_of(IN_PLANE)
    processor, device = together(IN_PLANE, 8)
    moved_out, moved_in = MeshlessGas(params), DeviceGas(params, DEVICE)
    moved_out.load(device.save())
    moved_in.load(processor.save())
    for _ in range(8):
        step = processor.stable_dt()
        for gas in (processor, moved_out, moved_in):
            gas.step(step)
    uninterrupted = processor.save()["conservative"]
    for gas in (moved_out, moved_in):
        assert apart(uninterrupted, gas.save()["conservative"]) < 1e-13


BODY = IN_PLANE["moving"]["bodies"][0]
DRIVEN = IN_PLANE | {"moving": {"bodies": [BODY | {"is_driven": True}]}}


def test_a_partner_moves_a_body_on_a_device_and_gets_its_load():
    params, loads = params_of(DRIVEN), []
    for gas in (MeshlessGas(params), DeviceGas(params, DEVICE)):
        position, velocity = np.array([BODY["centre"]]), np.array([BODY["velocity"]])
        gas.bind({"motion.radius": np.array([BODY["radius"]]), "motion.mass": np.ones(1)},
                 frozenset({"motion", "load"}))  # fmt: skip
        for _ in range(10):
            step = 0.01
            gas.take({"motion.position": position + 0.5 * step * velocity,
                      "motion.velocity": velocity})  # fmt: skip
            gas.step(step)
            position, velocity = position + step * velocity, velocity * 0.99
        loads.append(gas.give(frozenset({"load.force"}))["load.force"])
        assert np.any(loads[-1])
        work = gas.save()["work"]
        loads.append(np.array([work]))
    assert apart(loads[0], loads[2]) < 1e-12
    assert apart(loads[1], loads[3]) < 1e-11


def test_a_step_of_bodies_that_fails_does_so_as_on_the_processor():
    params, messages = params_of(IN_PLANE | {"courant": 6.0}), []
    for gas in (MeshlessGas(params), DeviceGas(params, DEVICE)):
        with pytest.raises(StepError, match="density and pressure must stay above 0") as error:
            advanced(gas, 20)
        messages.append(str(error.value))
    assert messages[0] == messages[1]
