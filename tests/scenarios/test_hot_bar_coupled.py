"""A bar of elements and mass points; all bars resume with the same bits."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from quintet.coupler.cli import main
from quintet.coupler.files.recording import Recording
from quintet.coupler.report.diff import compare
from quintet.coupler.run import snapshots
from quintet.coupler.run.simulate import make_folder, simulate
from quintet.coupler.scene.read import load
from quintet.scenarios.hot_bar_coupled.exchanges import reached, standard_error

SHORT = {  # of each scene: settings with which it takes a second
    "hot_bar": {"end": 1.0, "window": 0.1, "components.bar.substeps": 200},
    "hot_bar_baths": {"end": 2.0, "window": 0.2, "components.bar.substeps": 200},
    "heated_slab": {"end": 0.5},
    "hot_bar_coupled": {"end": 0.8, "window": 0.1},
}


def settings(scene: str) -> list[str]:
    """Settings of a short run without pictures, with snapshots."""
    plain = {"output.interval": 0, "output.pictures": "[]", **SHORT[scene]}
    plain["output.snapshots"] = 0.4 * SHORT[scene]["end"]
    return [f"{key}={value}" for key, value in plain.items()]


def run(folder: Path, scene: str, *arguments: str) -> Path:
    options = [word for setting in settings(scene) for word in ("--set", setting)]
    with pytest.raises(SystemExit) as ended:
        main(["run", scene, *options, *arguments, "--out", str(folder)])
    assert ended.value.code in (0, 1)  # too short for what the scene expects
    return folder


def test_a_bar_of_elements_and_points_has_the_temperature_between_them(tmp_path: Path) -> None:
    """Exchanges are short and noise is wide; the heat that leaves one side reaches the other."""
    with pytest.raises(SystemExit) as ended:
        main([
            "run", "hot_bar_coupled", "--preset", "quick", "--transport", "memory",
            "--out", str(tmp_path / "run"),
        ])  # fmt: skip
    assert ended.value.code == 0
    results = json.loads((tmp_path / "run" / "results.json").read_text())
    by_name = {outcome["name"]: outcome for outcome in results["expect"]}
    assert by_name["temperature between"]["met"] and by_name["heat flow"]["met"]
    assert results["ledger"]["links"][0]["heat_residual"] <= 1e-12
    with Recording(tmp_path / "run") as recording:
        between = recording.field("elements", "node_temperature.temperature")[1:].mean(axis=1)
    assert reached(between) <= 8  # exchanges
    assert abs(between[8:].mean() - 390.9) < 5.0 * standard_error(between[8:])


def test_what_is_reached_is_told_apart_from_noise() -> None:
    """For an error that halves at every exchange, in noise of standard deviation one."""
    noise = np.random.default_rng(3).normal(size=200)
    values = 50.0 + 64.0 * 0.5 ** np.arange(24) + noise[:24]
    assert 4 <= reached(values) <= 7  # the error is 8 and 1 there
    assert standard_error(noise) == pytest.approx(1.0 / np.sqrt(200), rel=0.2)


@pytest.mark.parametrize("scene", SHORT)
def test_from_a_snapshot_a_bar_goes_on_with_the_same_bits(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, scene: str
) -> None:
    monkeypatch.setattr(snapshots, "remove", lambda paths: None)
    first, resumed = tmp_path / "first", tmp_path / "again"
    loaded = load(scene, settings=settings(scene), transport="memory")
    make_folder(loaded, first)
    assert simulate(loaded, first) in (0, 1)
    shutil.copytree(first, resumed)
    files = sorted(resumed.glob("snapshot-*.h5"), key=snapshots.window_of)
    simulate(load(scene, settings=settings(scene), transport="memory"), resumed, files[0])
    assert compare(first, resumed) is None
    assert (first / "ledger.csv").read_bytes() == (resumed / "ledger.csv").read_bytes()


@pytest.mark.full
@pytest.mark.parametrize("transport", ["zenoh", "mpi"])
@pytest.mark.parametrize("scene", ["hot_bar", "hot_bar_coupled"])
def test_a_bar_has_the_same_bits_over_every_transport(
    tmp_path: Path, scene: str, transport: str
) -> None:
    memory = run(tmp_path / "memory", scene, "--transport", "memory")
    assert compare(memory, run(tmp_path / transport, scene, "--transport", transport)) is None
