"""Pucks slowed down by air: v = v0 exp(-c t / m), and half their energy lost comes back as heat.

The pose goes one way, force and heat come back, over a direct link.
"""

import math

import laboratory
import numpy as np
import pytest

MASS, DRAG, SHARE, END = 2.0, 1.0, 0.4, 2.0
START = np.array([[3.0, 0.0, 0.0], [0.0, -1.0, 0.5]])  # m/s
RATIOS = [1, 7, 50]
LINK = {
    "kind": "direct",
    "pairs": [["pucks.flight", "air.flight"], ["air.breath", "pucks.breath"]],
}


def _run(folder, window, ratio, scheme="serial", order=("pucks", "air"), **settings):
    components = {
        "pucks": {"kind": "toy_points:Pucks", "mass": MASS, "dt": window},
        "air": {"kind": "toy_points:Air", "drag": DRAG, "share": SHARE, "dt": window / ratio},
    }
    path = laboratory.scene(
        folder,
        components,
        LINK,
        end=END,
        window=window,
        scheme=scheme,
        order=list(order),
        **settings,
    )
    return laboratory.couple(path)


def _velocity_error(trace):
    exact = START * math.exp(-DRAG * END / MASS)
    return float(np.abs(trace.history("pucks", "flight.velocity")[-1] - exact).max())


@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize(
    ("scheme", "order", "size"),
    [("serial", 1.9, 2e-5), ("parallel", 0.95, 0.01), ("iterated", 1.9, 2e-5)],
)
def test_drag_converges_to_the_exact_decay(tmp_path, scheme, order, size, ratio):
    errors = [
        _velocity_error(_run(tmp_path, window, ratio, scheme)) for window in (0.1, 0.05, 0.025)
    ]
    assert errors[-1] < size
    assert min(laboratory.orders(errors)) > order


@pytest.mark.parametrize("order", [("pucks", "air"), ("air", "pucks")])
@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize("scheme", ["serial", "parallel", "iterated"])
def test_momentum_and_heat_close_to_rounding(tmp_path, scheme, ratio, order):
    trace = _run(tmp_path, 0.05, ratio, scheme, order)
    account = trace.account
    assert account.momentum_residual <= 1e-12
    assert account.heat_residual <= 1e-12
    assert account.kinematic_residual <= 1e-12
    # The air gains the pucks' momentum, except the last window's impulse where it comes late.
    late = scheme == "parallel" or (scheme == "serial" and order[0] == "pucks")
    transit = laboratory.in_transit(trace, "air", "breath.force") if late else np.zeros(3)
    rest = trace.coupling.in_transit.get(("pucks", "breath.force"), np.zeros((1, 3))).sum(axis=0)
    total = trace.momentum() + transit + rest
    np.testing.assert_allclose(total, MASS * START.sum(axis=0), rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("scheme", ["serial", "parallel", "iterated"])
def test_total_energy_converges(tmp_path, scheme):
    drifts = []
    for window in (0.1, 0.05, 0.025):
        energies = _run(tmp_path, window, 7, scheme).energies
        drifts.append(max(abs(energy - energies[0]) for energy in energies))
    assert min(laboratory.orders(drifts)) > (1.9 if scheme == "iterated" else 0.9)


def test_work_of_both_sides_agrees_ever_better(tmp_path):
    residuals = [_run(tmp_path, window, 7).account.energy_residual for window in (0.1, 0.05, 0.025)]
    assert residuals[-1] < 0.02
    assert min(laboratory.orders(residuals)) > 0.9
    assert _run(tmp_path, 0.05, 1, "iterated").account.energy_residual < 1e-6


@pytest.mark.zenoh
def test_zenoh_gives_the_bits_of_memory(tmp_path, monkeypatch):
    from quintet.coupler.report.diff import compare
    from quintet.coupler.run.simulate import make_folder, simulate
    from quintet.coupler.scene.read import load

    monkeypatch.setenv("PYTHONPATH", str(laboratory.HERE))  # where the toys are
    path = laboratory.scene(
        tmp_path,
        {"pucks": {"kind": "toy_points:Pucks"}, "air": {"kind": "toy_points:Air", "dt": 0.007}},
        LINK,
        end=1.0,
        window=0.05,
        scheme="iterated",
    )
    for transport in ("memory", "zenoh"):
        folder = tmp_path / transport
        scene = load(str(path), transport=transport)
        make_folder(scene, folder)
        assert simulate(scene, folder) == 0
    assert compare(tmp_path / "memory", tmp_path / "zenoh") is None
