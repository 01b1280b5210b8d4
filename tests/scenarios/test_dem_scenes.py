"""The scenes of rigid bodies, coarse: each reproduces its references."""

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

from quintet.coupler.cli import main
from quintet.coupler.files.recording import Recording


def run(scene: str, out: Path) -> dict:
    with pytest.raises(SystemExit) as ended:
        main(["run", scene, "--preset", "quick", "--out", str(out)])
    results = json.loads((out / "results.json").read_text())
    assert ended.value.code == 0, results["expect"]
    return results


@pytest.mark.parametrize(("scene", "count"), [("sphere_rebound", 17), ("block_on_slope", 7)])
def test_scene_reproduces_its_exact_solutions(scene: str, count: int, tmp_path: Path) -> None:
    assert [outcome["met"] for outcome in run(scene, tmp_path)["expect"]] == [True] * count


def run_series(command: str, out: Path, *options: str) -> dict:
    with pytest.raises(SystemExit) as ended:
        main([command, "sphere_rebound", "--out", str(out), *options])
    assert ended.value.code == 0
    return json.loads((out / f"{command}.json").read_text())


def test_impacts_are_of_second_order_in_the_step(tmp_path: Path) -> None:
    study = run_series("study", tmp_path)
    assert [row["status"] for row in study["rows"]] == ["done"] * 5
    orders = study["kinds"]["time step"]["orders"]
    damped = [orders[f"restitution_{e}"]["order"] for e in (0.2, 0.4, 0.6, 0.8)]
    assert 1.8 < min(damped) and max(damped) < 2.7
    assert [row["label"] for row in study["rows"] if row["met"]] == ["0.2 us", "0.1 us", "0.05 us"]


def test_an_impact_breaks_where_half_a_step_is_the_inverse_of_its_frequency(tmp_path: Path) -> None:
    """As one contact of Hertz's law does by itself: the energy doubles at 0.89 of 2/ω."""
    coarse = ("--set", "stability.0.accuracy=0.1", "--set", "stability.0.from=1e-5")
    one_stiffness = (
        "--set", "stability.0.against.values=[4.8e10]", "--set", "stability.0.predicted=2e-5",
    )  # fmt: skip
    limits = run_series(
        "stability", tmp_path, *coarse, *one_stiffness, "--set", "stability.0.to=4e-5"
    )["limits"]
    assert [limit["broke"] for limit in limits] == ["energy"]
    assert limits[0]["holds"] < 0.89 * 2.002e-5 < limits[0]["breaks"]


def test_spheres_settle_into_a_random_packing(tmp_path: Path) -> None:
    """Its fraction away from the walls, its overlaps, and the way in which it loses its energy."""
    assert [outcome["met"] for outcome in run("settling_packing", tmp_path)["expect"]] == [True] * 3
    with Recording(tmp_path) as recording:
        x = recording.field("spheres", "motion.position", slice(-1, None))[0]  # (n, 3) m
        speed = np.linalg.norm(recording.field("spheres", "motion.velocity"), axis=2)
        mass = recording.static("spheres")["motion.mass"]
    d, box = 0.01, np.array([0.1, 0.1, np.quantile(x[:, 2], 0.95)])  # m
    low, high = np.full(3, 1.5 * d), box - 1.5 * d
    points = low + np.random.default_rng(0).random((50_000, 3)) * (high - low)
    fraction = (cKDTree(x).query(points)[0] < 0.5 * d).mean()
    assert 0.55 < fraction < 0.64
    kinetic = 0.5 * (mass * speed**2).sum(axis=1)
    assert kinetic[-1] < 1e-6 * kinetic.max()
    i, j = cKDTree(x).query_pairs(d, output_type="ndarray").T
    overlap = d - np.linalg.norm(x[i] - x[j], axis=1)  # m
    # By Hertz's law of the weight that stands on one sphere of the floor. Forces in a packing fall
    # off as exp(-1.5 f / mean) (Mueth, Jaeger & Nagel, Phys. Rev. E 57 (1998) 3164): of some
    # thousands none is above 8.
    modulus, column = 2e6 / (2.0 * 0.91), 9.81 * mass.sum() * d**2 / (box[0] * box[1])
    deepest = (0.75 * column / (modulus * np.sqrt(0.25 * d))) ** (2.0 / 3.0)
    assert overlap.mean() < deepest
    assert overlap.max() < 8.0 ** (2.0 / 3.0) * deepest
