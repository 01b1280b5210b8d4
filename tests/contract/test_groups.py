"""A group in small windows inside a large one: as good as small windows throughout, and cheaper."""

import laboratory
import numpy as np
import pytest

from quintet.interfaces.errors import SceneError

KIND = "quintet.scenarios.two_springs.springs:Mass"
END, SMALL, LARGE = 0.48, 2e-3, 0.02
# Two stiff masses, the upper on the lower one; a heavy one hangs on the upper by a soft spring.
UP = [0.0, 0.0, 0.5]
COMPONENTS = {
    "lower": {"kind": KIND, "mass": 1.0, "stiffness": 4e3, "arm": UP, "start": UP},
    "upper": {"kind": KIND, "mass": 0.5, "stiffness": 2e3, "arm": UP, "start": [0.02, 0.0, 1.01]},
    "slow": {"kind": KIND, "mass": 5.0, "stiffness": 40.0, "arm": UP, "start": [0.1, 0.0, 1.55]},
}


def _ride(rider, ridden):
    pairs = [[f"{ridden}.motion", f"{rider}.foot"], [f"{rider}.foot_load", f"{ridden}.load"]]
    return {"kind": "direct", "name": f"{rider} on {ridden}", "pairs": pairs}


LINKS = [_ride("upper", "lower"), _ride("slow", "upper")]
PAIR = {"pair": {"members": ["lower", "upper"], "scheme": "iterated", "window": SMALL}}


def _run(folder, window, groups=None, scheme="iterated", **settings):
    options = {"groups": groups} if groups else {}
    path = laboratory.scene(
        folder, COMPONENTS, LINKS, end=END, window=window, scheme=scheme, **options, **settings
    )
    return laboratory.couple(path)


def _ends(trace):
    return {
        name: trace.outputs[-1][name]["motion.position"][0] for name in ("lower", "upper", "slow")
    }


def _calls(trace):
    """Number of windows of each component, repetitions included."""
    return {name: component.timing.windows for name, component in trace.coupling.components.items()}


@pytest.fixture(scope="module")
def small_windows(tmp_path_factory):
    """All in small windows."""
    return _run(tmp_path_factory.mktemp("small"), SMALL)


@pytest.fixture(scope="module")
def two_rates(tmp_path_factory):
    """The pair in small windows, the slow mass in large ones."""
    return _run(tmp_path_factory.mktemp("two"), LARGE, PAIR)


def test_two_rates_give_the_answer_of_small_windows_for_less(small_windows, two_rates):
    reference, ends = _ends(small_windows), _ends(two_rates)
    for name, exact in reference.items():
        np.testing.assert_allclose(ends[name], exact, atol=2e-4)  # of swings of 0.1 m
    assert _calls(two_rates)["slow"] < 0.15 * _calls(small_windows)["slow"]
    for trace in (small_windows, two_rates):
        for account in trace.coupling.ledger.accounts.values():
            assert account.momentum_residual <= 1e-12
            assert account.kinematic_residual <= 1e-12


def test_the_error_of_a_large_window_falls_at_second_order(tmp_path, small_windows, two_rates):
    traces = _run(tmp_path, 2.0 * LARGE, PAIR), two_rates, _run(tmp_path, 0.5 * LARGE, PAIR)
    errors = [np.abs(_ends(trace)["slow"] - _ends(small_windows)["slow"]).max() for trace in traces]
    assert min(laboratory.orders(errors)) > 1.7


@pytest.mark.parametrize("scheme", ["serial", "parallel", "iterated"])
@pytest.mark.parametrize("inner", ["serial", "parallel", "iterated"])
@pytest.mark.parametrize("order", [["pair", "slow"], ["slow", "pair"]])
def test_momentum_closes_to_rounding_in_every_scheme(tmp_path, scheme, inner, order):
    groups = {"pair": {**PAIR["pair"], "scheme": inner}}
    trace = _run(tmp_path, LARGE, groups, scheme, order=order)
    for account in trace.coupling.ledger.accounts.values():
        assert account.momentum_residual <= 1e-12


def test_a_group_may_follow_the_state_within_fixed_windows(tmp_path, small_windows):
    groups = {"pair": {**PAIR["pair"], "window": "auto"}}
    trace = _run(tmp_path, LARGE, groups)
    assert trace.times[-1] == END
    np.testing.assert_allclose(np.diff(trace.times), LARGE, rtol=1e-9)
    np.testing.assert_allclose(_ends(trace)["slow"], _ends(small_windows)["slow"], atol=1e-3)


def test_groups_in_groups_are_groups(tmp_path, two_rates):
    groups = {**PAIR, "all": {"members": ["pair", "slow"], "scheme": "iterated", "window": LARGE}}
    nested = _run(tmp_path, 2 * LARGE, groups)
    for name, exact in _ends(two_rates).items():
        np.testing.assert_allclose(_ends(nested)[name], exact, atol=1e-9)


@pytest.mark.parametrize(
    ("groups", "words"),
    [
        ({"pair": {"members": ["lower", "uper"]}}, "groups.pair.members: uper is not known"),
        ({"lower": {"members": ["lower"]}}, "a name must be .* and no component's; found 'lower'"),
        (
            {"one": {"members": ["lower"]}, "two": {"members": ["lower", "upper"]}},
            "lower is in 2 of them",
        ),
        ({"one": {"members": ["two"]}, "two": {"members": ["one"]}}, "it is in itself"),
        ({"pair": {"members": ["lower"], "widnow": 1.0}}, "Did you mean window"),
    ],
)
def test_mistakes_in_groups_are_told(tmp_path, groups, words):
    with pytest.raises(SceneError, match=words):
        _run(tmp_path, LARGE, groups)
