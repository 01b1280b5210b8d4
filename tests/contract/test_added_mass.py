"""A mass on a spring carries a second one; staggered schemes fail if the second is heavier.

Together they swing as cos(√(k / (m + m')) t); the carried mass answers with -m' dv/dt.
"""

import math

import laboratory
import numpy as np
import pytest

STIFFNESS, END = 10.0, 2.0
LINK = {
    "kind": "direct",
    "pairs": [["swing.swing", "burden.carried"], ["burden.lump", "swing.lump"]],
}


def _run(folder, window, burden, scheme, ratio=1, **settings):
    components = {
        "swing": {"kind": "toy_points:Swing", "stiffness": STIFFNESS, "dt": window},
        "burden": {"kind": "toy_points:Burden", "mass": burden, "dt": window / ratio},
    }
    path = laboratory.scene(
        folder, components, LINK, end=END, window=window, scheme=scheme, **settings
    )
    return laboratory.couple(path)


def _error(trace, burden):
    exact = np.cos(math.sqrt(STIFFNESS / (1.0 + burden)) * trace.times)
    return float(np.abs(trace.history("swing", "swing.position")[:, 0, 0] - exact).max())


@pytest.mark.parametrize("scheme", ["serial", "parallel"])
def test_staggered_schemes_hold_with_a_light_burden_only(tmp_path, scheme):
    errors = [_error(_run(tmp_path, window, 0.5, scheme), 0.5) for window in (0.02, 0.01, 0.005)]
    assert errors[-1] < 0.02
    assert min(laboratory.orders(errors)) > 0.8
    heavy = _run(tmp_path, 0.01, 2.0, scheme)
    assert _error(heavy, 2.0) > 1e20  # and shorter windows make it worse
    assert heavy.account.momentum_residual <= 1e-12


@pytest.mark.parametrize("ratio", [1, 7, 50])
def test_iterated_windows_converge_with_a_heavy_burden(tmp_path, ratio):
    errors = []
    for window in (0.02, 0.01, 0.005):
        trace = _run(tmp_path, window, 2.0, "iterated", ratio)
        assert trace.account.momentum_residual <= 1e-12
        errors.append(_error(trace, 2.0))
    assert errors[-1] < 1e-5
    assert min(laboratory.orders(errors)) > 1.9


def test_the_frequency_is_exact(tmp_path):
    trace = _run(tmp_path, 0.005, 2.0, "iterated")
    position = trace.history("swing", "swing.position")[:, 0, 0]
    first = int(np.flatnonzero(position <= 0.0)[0])
    quarter = np.interp(0.0, position[[first, first - 1]], trace.times[[first, first - 1]])
    exact = 0.5 * math.pi * math.sqrt(3.0 / STIFFNESS)
    assert abs(quarter - exact) < 1e-5 * exact


def test_aitken_needs_two_repetitions(tmp_path):
    trace = _run(tmp_path, 0.01, 2.0, "iterated")
    assert trace.coupling.costs.repetitions / (len(trace.outputs) - 1) <= 2.1


def test_constant_relaxation_needs_more_and_too_much_diverges(tmp_path):
    iteration = {"acceleration": "constant", "relaxation": 0.2}
    constant = _run(tmp_path, 0.01, 2.0, "iterated", iteration=iteration)
    aitken = _run(tmp_path, 0.01, 2.0, "iterated")
    assert constant.coupling.costs.repetitions > 3 * aitken.coupling.costs.repetitions
    assert _error(constant, 2.0) == pytest.approx(_error(aitken, 2.0), rel=1e-2)
    from quintet.interfaces.errors import StepError

    with pytest.raises(StepError, match=r"window \d+ did not converge within \d+ iterations"):
        _run(
            tmp_path,
            0.01,
            2.0,
            "iterated",
            iteration={"acceleration": "constant", "relaxation": 0.9},
        )


def test_what_an_iteration_lacks_is_applied_in_the_next_window(tmp_path):
    loose = _run(
        tmp_path, 0.01, 2.0, "iterated", iteration={"tolerance": 0.05, "acceleration": "constant"}
    )
    account = loose.account
    assert account.momentum_residual <= 1e-12
    impulse = loose.history("burden", "lump.force").sum(axis=(0, 1))
    in_transit = loose.coupling.in_transit["swing", "lump.force"].sum(axis=0)
    assert np.abs(in_transit).max() > 1e-6  # the iteration did stop early
    momentum = loose.momentum()  # of both; the wall holds the spring's other end
    np.testing.assert_allclose(impulse[1:], 0.0)
    position = loose.history("swing", "swing.position")[:, 0, 0]
    middle = 0.5 * (position[1:] + position[:-1])
    wall = -STIFFNESS * loose.coupling.last_dt * middle.sum()
    assert momentum[0] + in_transit[0] == pytest.approx(wall, rel=2e-3)


def test_at_the_limit_of_repetitions_a_run_may_go_on_and_counts_the_windows(tmp_path):
    iteration = {"limit": 2, "at_limit": "continue", "acceleration": "constant"}
    trace = _run(tmp_path, 0.01, 0.5, "iterated", iteration=iteration)
    assert trace.coupling.costs.unconverged > 0.9 * (len(trace.outputs) - 1)
    assert trace.account.momentum_residual <= 1e-12  # the rest was applied a window later


def test_an_absolute_tolerance_is_met_sooner(tmp_path):
    tight = _run(tmp_path, 0.01, 2.0, "iterated")
    iteration = {"absolute": {"swing.lump.force": 0.5}}
    loose = _run(tmp_path, 0.01, 2.0, "iterated", iteration=iteration)
    assert loose.coupling.costs.repetitions < 0.8 * tight.coupling.costs.repetitions
    assert loose.account.momentum_residual <= 1e-12
