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


def test_what_comes_from_beyond_several_groups_reaches_a_group_in_a_group(tmp_path, two_rates):
    """The slow mass hangs on the upper one, which is two groups away."""
    alone = {"members": ["upper"], "window": SMALL}
    groups = {"alone": alone, "pair": {**PAIR["pair"], "members": ["lower", "alone"]}}
    nested = _run(tmp_path, LARGE, groups)
    for name, exact in _ends(two_rates).items():
        np.testing.assert_array_equal(_ends(nested)[name], exact)
    for account in nested.coupling.ledger.accounts.values():
        assert account.momentum_residual <= 1e-12
        assert account.kinematic_residual <= 1e-12


@pytest.mark.parametrize("scheme", ["serial", "parallel", "iterated"])
@pytest.mark.parametrize("inner", ["serial", "iterated"])
def test_forces_from_within_a_group_and_from_outside_add_up(tmp_path, scheme, inner):
    """Two masses ride on the lower one, of which one is in its group and steps before it."""
    links = [_ride("upper", "lower"), _ride("slow", "lower")]
    groups = {"pair": {"members": ["upper", "lower"], "scheme": inner, "window": SMALL}}
    keys = {"end": 0.1, "window": LARGE, "scheme": scheme, "groups": groups}
    trace = laboratory.couple(laboratory.scene(tmp_path, COMPONENTS, links, **keys))
    for account in trace.coupling.ledger.accounts.values():
        assert np.abs(account.impulse).max() > 1e-3
        assert account.momentum_residual <= 1e-12


@pytest.mark.parametrize("window", ["auto", LARGE])
def test_a_group_that_no_member_limits_steps_with_the_coupling_around_it(tmp_path, window):
    body = {"shape": "sphere", "radius": 0.1, "mass": 1.0, "centre": [0.0, 0.0, 0.0]}
    free = {"kind": "prescribed", "bodies": [body]}
    components = {"first": free, "second": free, "upper": COMPONENTS["upper"]}
    link = {"kind": "direct", "name": "ride", "pairs": [["first.motion", "upper.foot"]]}
    groups = {"paths": {"members": ["first", "second"]}}
    trace = laboratory.couple(
        laboratory.scene(tmp_path, components, link, end=0.1, window=window, groups=groups)
    )
    calls = _calls(trace)
    assert calls["first"] == calls["upper"] == len(trace.times) - 1
    assert trace.times[-1] == 0.1


def test_a_flag_from_outside_changes_where_the_outer_window_ends(tmp_path):
    """13 windows of 7 ms / 13 are less than 7 ms by rounding."""
    components = {"switch": {"kind": "toy_switches:Switch"}, "lamp": {"kind": "toy_switches:Lamp"}}
    pairs = [["switch.state", "lamp.state"]]
    groups = {"inside": {"members": ["lamp"], "window": 7e-3 / 13}}
    trace = laboratory.couple(
        laboratory.scene(
            tmp_path, components, {"kind": "direct", "name": "wire", "pairs": pairs},
            end=3 * 7e-3, window=7e-3, groups=groups,
        )
    )  # fmt: skip
    seen = trace.components["lamp"].seen
    assert seen == [1.0] * 13 + [0.0] * 26


def test_windows_at_the_limit_count_once_however_often_they_are_repeated(tmp_path):
    limited = {"limit": 1, "at_limit": "continue"}
    trace = _run(tmp_path, LARGE, {"pair": {**PAIR["pair"], "iteration": limited}})
    assert trace.coupling.costs.repetitions > 0
    windows = trace.coupling.members["pair"].inner.windows.done
    assert trace.coupling.costs.unconverged == windows == round(END / SMALL)


def test_motion_of_two_times_is_refused_before_anything_starts(tmp_path):
    """The gust would get one plate at a window's end, the other at its beginning."""
    plate = {"kind": "toy_plates:Plate", "dt": 0.02}
    components = {"b": plate, "gust": {"kind": "toy_plates:Gust", "dt": 0.02}, "a": plate}
    links = [{"kind": "fsi", "name": name, "between": ["gust", name]} for name in "ab"]
    groups = {"near": {"members": ["gust", "a"], "window": 0.02}}
    path = laboratory.scene(tmp_path, components, links, end=0.1, window=0.02, groups=groups)
    words = "inputs of gust.surface from within the group .* the beginning of a window within it"
    with pytest.raises(SceneError, match=words):
        laboratory.couple(path)


def test_a_force_that_two_links_carry_to_one_input_is_refused(tmp_path):
    again = {"kind": "direct", "name": "again", "pairs": [["upper.foot_load", "lower.load"]]}
    path = laboratory.scene(tmp_path, COMPONENTS, [*LINKS, again], end=END, window=LARGE)
    with pytest.raises(SceneError, match=r"link again: .* once; link upper on lower brings it"):
        laboratory.couple(path)


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
