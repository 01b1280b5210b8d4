"""Clouds too coarse for their flow warn; settings with meaningless results are refused."""

import pytest
from gases import SOD, gas_in_box, tube
from test_sidedness import ROUND

from quintet.components.meshless_gas.component import MeshlessGas
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.params import read

AIR = {"density": 1.0, "pressure": 1.0}
NO_SLIP = {"kind": "isothermal", "temperature": 1.0}


def gap(nodes):
    spacing = 1.0 / (nodes - 1)
    box = {"highest": [4.0 * spacing, 0.0, 1.0], "spacing": spacing, "jitter": 0.0}
    return gas_in_box(initial=AIR, viscous=True, box=box, boundaries={"z-": NO_SLIP, "z+": NO_SLIP})


def vortex(spacing):
    middle = {"centre": [5.0, 0.0, 5.0], "strength": 5.0}
    box = {"highest": [10.0, 0.0, 10.0], "spacing": spacing}
    return gas_in_box(initial=AIR, vortex=middle, box=box)


def sphere(layers, margin):
    cloud = {"radius": 1.0, "points_around": 12, "layers": {"count": layers}, "margin": margin}
    params, mistakes = read(MeshlessGasParams, ROUND | {"sphere": cloud}, "gas")
    assert not mistakes
    return MeshlessGas(params)


@pytest.mark.parametrize(
    ("fine", "coarse", "sentence"),
    [
        (lambda: tube(25, *SOD), lambda: tube(11, *SOD), "nodes along it"),
        (lambda: vortex(0.45), lambda: vortex(0.8), "spacings in its radius"),
        (lambda: gap(5), lambda: gap(3), "nodes between its walls"),
        (lambda: sphere(12, 1.35), lambda: sphere(24, 8.0), "raise layers.count"),
    ],
    ids=["tube", "vortex", "gap", "sphere"],
)
def test_what_is_too_coarse_is_warned_of(fine, coarse, sentence):
    assert fine().warnings() == {}
    assert sentence.lower() in coarse().warnings()["resolution"].lower()


def test_what_counts_as_settled_too_early_is_warned_of():
    for change, subjects in ((1e-5, set()), (1e-2, {"steady"})):
        gas = tube(50, *SOD, steady={"change": change})
        assert set(gas.warnings()) == subjects


def test_the_first_order_is_warned_of():
    assert "Leave order out" in tube(50, *SOD, order=1).warnings()["order"]


@pytest.mark.parametrize(
    ("keys", "sentence"),
    [
        ({"viscous": True, "order": 1}, "viscous needs order = 2"),
        ({"local_steps": True, "vortex": {"centre": [0.5, 0.0, 0.5], "strength": 1.0}}, "steady"),
    ],
)
def test_settings_whose_results_would_mean_nothing_are_refused(keys, sentence):
    box = {"lowest": [0.0] * 3, "highest": [1.0, 0.0, 1.0], "spacing": 0.1}
    (mistake,) = read(MeshlessGasParams, {"box": box, "initial": AIR, **keys}, "gas")[1]
    assert sentence in mistake
