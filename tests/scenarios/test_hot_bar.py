"""The bars of mass points, coarse and short: drive, baths, and one conductivity."""

import json

import pytest

from quintet.coupler.cli import main


def run(folder, name, *arguments):
    """Run a scene; return its results."""
    with pytest.raises(SystemExit) as ended:
        main(["run", name, *arguments, "--transport", "memory", "--out", str(folder / name)])
    assert ended.value.code in (0, 1)  # shorter than what the scene expects
    return json.loads((folder / name / "results.json").read_text())


def value(results, name):
    return next(outcome["value"] for outcome in results["expect"] if outcome["name"] == name)


def test_a_driven_bar_of_16_points_accounts_for_its_energy(tmp_path):
    results = run(tmp_path, "hot_bar", "--preset", "points16")
    assert results["status"] == "done"
    assert abs(value(results, "audit")) < 1e-3
    assert value(results, "intact") == 1.0
    # Fitted by the damping to a third; by chaos it scatters by 0.02 from seed to seed.
    assert value(results, "level") == pytest.approx(0.335, abs=0.08)


def test_a_bar_between_baths_has_the_temperatures_of_the_graph(tmp_path):
    results = run(tmp_path, "hot_bar_baths", "--preset", "points16")
    assert value(results, "mean") == pytest.approx(216.9, rel=0.05)
    assert abs(value(results, "balance")) < 1e-3


def test_heat_flows_by_fourier(tmp_path):
    results = run(tmp_path, "conductivity", "--preset", "length10")
    assert value(results, "heat flow") == pytest.approx(2.731e-7, rel=0.1)
    assert abs(value(results, "balance")) < 2e-8


def test_a_bar_of_elements_has_the_temperatures_of_its_mesh(tmp_path):
    coarse = "components.bar.parts.0.elements=[36, 12, 12]"  # 0.833 mm
    results = run(tmp_path, "hot_bar_elements", "--set", coarse)
    assert value(results, "mean") == pytest.approx(169.62, rel=2e-3)
    assert value(results, "heat") > 0.0


def test_a_slab_that_is_heated_through_one_face_follows_its_series(tmp_path):
    results = run(tmp_path, "heated_slab")
    assert all(outcome["met"] for outcome in results["expect"])
