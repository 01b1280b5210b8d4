"""A rarefied gas slips along walls on an OpenCL device as on the processor."""

import numpy as np
import pytest
from device_gases import DEVICE, STREAM, VISCOUS, advanced, apart, both, params_of, same_bits
from gases import state

from quintet.components.meshless_gas.component import MeshlessGas
from quintet.components.meshless_gas.viscous.terms import Viscous

pytest.importorskip("pyopencl")
from quintet.components.meshless_gas.opencl.device_gas import DeviceGas
from quintet.components.shared.opencl.devices import Device

NIGHTLY = pytest.mark.full  # programs of their own
SHARES = {"momentum": 0.9, "energy": 0.8}
# A wall that slips, one that is adiabatic and slips, and one that holds the gas.
BETWEEN_WALLS = VISCOUS | {
    "boundaries": {
        "x-": {"kind": "isothermal", "temperature": 1.0},
        "x+": STREAM["boundaries"]["x+"],
        "z-": {
            "kind": "isothermal", "temperature": 0.7, "velocity": [0.5, 0.0, 0.0],
            "accommodation": SHARES,
        },
        "z+": {"kind": "adiabatic", "accommodation": SHARES},
    },
}  # fmt: skip
FLOW = state(1.0, 6.0, 1.0 / 1.4)
SPHERE = {
    "axisymmetric": True,
    "viscous": True,
    "gas": {"gas_constant": 1.0 / 1.4, "viscosity": 0.02, "reference_temperature": 1.0},
    "initial": FLOW,
    "sphere": {"radius": 1.0, "points_around": 24, "layers": {"count": 24}},
    "boundaries": {
        "wall": {"kind": "isothermal", "temperature": 1.0, "accommodation": SHARES},
        "far": {"kind": "inflow", "state": FLOW},
        "exit": {"kind": "outflow"},
    },
}
LOADS = frozenset({"wall.friction", "wall.heat_flux", "wall.pressure", "body.force"})


@pytest.mark.parametrize(
    ("table", "steps"),
    [(BETWEEN_WALLS, 100), (SPHERE, 60), pytest.param(BETWEEN_WALLS, 1000, marks=NIGHTLY)],
)
def test_a_gas_slips_and_its_temperature_jumps_as_on_the_processor(table, steps):
    processor, device = both(DeviceGas, table, steps)
    first, second = processor.save(), device.save()
    for key in ("conservative", "primitive", "entered", "work"):
        assert np.any(first[key]) and apart(first[key], second[key]) < 1e-12, key
    expected, computed = processor.give(LOADS), device.give(LOADS)
    for name in LOADS:
        assert np.any(expected[name]) and apart(expected[name], computed[name]) < 1e-11, name
    held = advanced(DeviceGas(params_of(without_slip(table)), DEVICE), 5).save()["primitive"]
    slipping = advanced(DeviceGas(params_of(table), DEVICE), 5).save()["primitive"]
    assert apart(held, slipping) > 1e-3  # walls that slip make a difference


def without_slip(table):
    walls = {
        name: {key: value for key, value in boundary.items() if key != "accommodation"}
        for name, boundary in table["boundaries"].items()
    }
    return table | {"boundaries": walls}


def test_an_accommodation_without_wall_nodes_leaves_the_gas_as_it_is_without(monkeypatch):
    monkeypatch.setattr(Viscous, "__init__", without_rarefied_nodes(Viscous.__init__))
    slipping, held = (
        advanced(DeviceGas(params_of(table), DEVICE), 3)
        for table in (BETWEEN_WALLS, without_slip(BETWEEN_WALLS))
    )
    same_bits(slipping.save(), held.save())


def without_rarefied_nodes(make):
    """Friction of a cloud in which walls with accommodation have no nodes."""

    def make_without(self, *arguments):
        make(self, *arguments)
        self.rarefied, self.couples_walls = [], False

    return make_without


def test_a_device_that_is_no_processor_has_slipping_walls_by_columns(monkeypatch):
    monkeypatch.setattr(Device, "is_processor", property(lambda self: False))
    processor, device = both(DeviceGas, BETWEEN_WALLS, 20)
    assert not device.stepping.state.tables.by_rows
    assert apart(processor.save()["conservative"], device.save()["conservative"]) < 1e-13


def test_snapshots_of_a_gas_that_slips_go_on_with_the_same_bits_and_elsewhere():
    params = params_of(BETWEEN_WALLS)
    processor, device = both(DeviceGas, BETWEEN_WALLS, 10)
    loaded, moved_out, moved_in = (
        DeviceGas(params, DEVICE),
        MeshlessGas(params),
        DeviceGas(params, DEVICE),
    )
    loaded.load(device.save())
    moved_out.load(device.save())
    moved_in.load(processor.save())
    same_bits(advanced(device, 10).save(), advanced(loaded, 10).save())
    uninterrupted = advanced(processor, 10).save()["conservative"]
    for gas in (moved_out, moved_in):
        assert apart(uninterrupted, advanced(gas, 10).save()["conservative"]) < 1e-13
