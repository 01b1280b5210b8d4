"""Windows or relaxations that make the answer wrong end with status 1, and good ones with 0."""

import json
from pathlib import Path

import pytest

from quintet.coupler.cli import main
from quintet.coupler.coupling.judgement import time_check
from quintet.coupler.report.diff import compare
from quintet.coupler.scene.predicted_limits import beyond_limits
from quintet.coupler.scene.read import library, load

SERIAL, SHORT = "scheme='serial'", ("end=0.1", "expect=[]")


def run(out: Path, scene: str, *settings: str) -> tuple[int, dict]:
    """Run a scene over memory; return its exit status and its results."""
    options = [word for setting in settings for word in ("--set", setting)]
    with pytest.raises(SystemExit) as ended:
        main(["run", scene, "--transport", "memory", "--out", str(out), *options])
    return ended.value.code or 0, json.loads((out / "results.json").read_text())


# The lower mass ends at 11 m, at 2.6 m, 13 % of the lift off, and at 12 m; true is 0.5 to 0.6 m.
@pytest.mark.parametrize(
    ("scheme", "stiffness"),
    [
        ("serial", 1e7),
        ("iterated", 1e5),
        pytest.param("serial", 1e8, marks=pytest.mark.full),
        pytest.param("iterated", 1e9, marks=pytest.mark.full),
    ],
)
def test_windows_longer_than_a_stiff_period_are_warned_of(tmp_path, scheme, stiffness):
    stiff = f"components.upper.stiffness={stiffness}"
    status, results = run(tmp_path / "run", "two_springs", f"scheme='{scheme}'", stiff, *SHORT)
    assert results["status"] == "done"
    assert status == 1
    texts = [
        warning["text"] for warning in results["warnings"] if warning["source"] == "link spring"
    ]
    assert any("windows of 0.002 s are too long" in text for text in texts)
    assert any("Set window to" in text for text in texts)


# Exact by normal modes: 2, 10 and 27 % of the lift off.
@pytest.mark.parametrize(
    ("window", "end", "expected_status"),
    [(1e-3, 1.0, 0), (4e-3, 1.0, 1), pytest.param(2e-3, 5.0, 1, marks=pytest.mark.full)],
)
def test_energy_that_a_staggered_link_makes_is_warned_of(tmp_path, window, end, expected_status):
    times = f"window={window}", f"end={end}"
    status, results = run(tmp_path / "run", "two_springs", SERIAL, *times, "expect=[]")
    assert status == expected_status
    assert ["more work than they gave" in warning["text"] for warning in results["warnings"]] == [
        True
    ] * expected_status


# Velocities are 1, 5 and 24 % off.
@pytest.mark.parametrize(
    ("window", "expected_status"),
    [(4e-5, 0), (1.6e-4, 1), pytest.param(6.4e-4, 1, marks=pytest.mark.full)],
)
def test_windows_longer_than_a_drag_relaxes_are_warned_of(tmp_path, window, expected_status):
    status, results = run(tmp_path / "run", "dust_in_stream", f"window={window}", "expect=[]")
    assert status == expected_status
    assert any(
        "too long: gas.particle" in warning["text"] for warning in results["warnings"]
    ) == bool(expected_status)


@pytest.mark.parametrize("window", [pytest.param(2e-3, marks=pytest.mark.full), 16e-3])
def test_windows_that_resolve_the_motion_are_not_warned_of(tmp_path, window):
    status, results = run(tmp_path / "run", "two_springs", f"window={window}", "expect=[]")
    assert (status, results["warnings"]) == (0, [])
    assert all(error["bias"] < 0.01 for error in results["time_errors"])


@pytest.mark.slow
def test_a_relaxation_that_lets_heat_swing_is_warned_of(tmp_path):
    preset = ("links.0.relaxation=1.0", "window=2.0", "end=24.0", "expect=[]")
    status, results = run(tmp_path / "run", "hot_bar_coupled", *preset)
    assert status == 1
    (warning,) = results["warnings"]
    assert "does not settle" in warning["text"]
    assert "Set relaxation of the link from 1 to 0.5 or less." in warning["text"]


@pytest.mark.parametrize(
    "scheme", ["serial", pytest.param("parallel", marks=pytest.mark.full), "iterated"]
)
def test_a_look_at_windows_changes_no_bit(tmp_path, monkeypatch, scheme):
    settings = f"scheme='{scheme}'", "end=0.15", "expect=[]"
    _, looked = run(tmp_path / "looked", "two_springs", *settings)
    monkeypatch.setattr(time_check, "is_sampled", lambda _: False)
    _, not_looked = run(tmp_path / "not", "two_springs", *settings)
    assert looked["time_errors"]
    assert not not_looked["time_errors"]
    assert compare(tmp_path / "looked", tmp_path / "not") is None
    for key in ("ledger", "repetitions", "windows"):
        assert looked[key] == not_looked[key]
    steps = [results["timing"]["components"]["lower"]["steps"] for results in (looked, not_looked)]
    assert steps[0] == steps[1]


LOADED = (
    "components.dust.spheres.0.parcel=55445000.0",
    "components.gas.initial.velocity=[10.0, 0.0, 0.0]",
    "components.dust.spheres.0.temperature=300.0",
    "components.dust.spheres.1.launch=1.0",
)


@pytest.mark.parametrize(("window", "count"), [(1.2e-3, 0), (1.4e-3, 1)])
def test_a_run_beyond_a_predicted_limit_of_its_scene_is_warned_of(window, count):
    """The predicted limit is 1.275 ms at this loading; the scene has others at other loadings."""
    scene = load("dust_in_stream", settings=[*LOADED, f"window={window}", "end=0.03347"])
    warnings = beyond_limits(scene)
    assert list(warnings) == ["window at a loading of 0.5"] * count
    assert all("window must be at most 0.001275" in text for text in warnings.values())


@pytest.mark.parametrize("name", sorted(library()))
def test_no_scene_runs_beyond_its_own_limits(name):
    assert beyond_limits(load(name)) == {}
