"""The tutorial's component: short, complete, and exact."""

import json
import math
from pathlib import Path

import laboratory
import numpy as np
import pytest

import quintet.scenarios
from quintet.coupler.run.simulate import make_folder, simulate
from quintet.coupler.scene.read import load

FOLDER = Path(quintet.scenarios.__path__[0]) / "two_springs"
GOLDEN = 0.5 * (1.0 + math.sqrt(5.0))
LIFT = 0.1  # m


def _exact(times):
    """Displacements of the lower and the upper mass, from the normal modes."""
    slow, fast = np.cos(10.0 * (GOLDEN - 1.0) * times), np.cos(10.0 * GOLDEN * times)
    amplitude = LIFT / (1.0 + GOLDEN**2)
    return amplitude * GOLDEN * (slow - fast), amplitude * (GOLDEN**2 * slow + fast)


def test_the_component_fits_on_a_screen():
    assert len((FOLDER / "springs.py").read_text().splitlines()) <= 60


def _run(tmp_path, transport, settings=()):
    scene = load(str(FOLDER / "scene.toml"), settings=settings, transport=transport)
    make_folder(scene, tmp_path / transport)
    status = simulate(scene, tmp_path / transport)
    return status, json.loads((tmp_path / transport / "results.json").read_text())


def test_two_springs_meet_what_they_expect(tmp_path):
    status, results = _run(tmp_path, "memory")
    assert status == 0
    end = [float(displacement) for displacement in _exact(1.0)]
    assert [expectation["reference"] for expectation in results["expect"]] == pytest.approx(
        end, abs=1e-9
    )
    (link,) = results["ledger"]["links"]
    assert link["momentum_residual"] <= 1e-12
    assert link["kinematic_residual"] <= 1e-12
    assert link["energy_residual"] <= 1e-6


@pytest.mark.zenoh
def test_two_springs_run_as_two_processes_with_the_same_bits(tmp_path):
    from quintet.coupler.report.diff import compare

    assert load(str(FOLDER / "scene.toml")).transport == "zenoh"
    for transport in ("memory", "zenoh"):
        assert _run(tmp_path, transport, ("end=0.2", "expect=[]"))[0] == 0
    assert compare(tmp_path / "memory", tmp_path / "zenoh") is None


@pytest.mark.parametrize(
    ("scheme", "order", "size"),
    [("serial", 0.9, 5e-3), ("parallel", 0.9, 5e-3), ("iterated", 1.9, 5e-6)],
)
def test_two_springs_converge_to_their_normal_modes(tmp_path, scheme, order, size):
    errors = []
    for window in (0.004, 0.002, 0.001):
        path = tmp_path / "scene.toml"
        text = (
            (FOLDER / "scene.toml")
            .read_text()
            .replace('"springs:', '"quintet.scenarios.two_springs.springs:')
        )
        text = text.replace("window = 0.002", f"window = {window}").replace(
            '"iterated"', f'"{scheme}"'
        )
        path.write_text(text.replace('"zenoh"', '"memory"'))
        trace = laboratory.couple(path)
        lower, upper = _exact(trace.times)
        errors.append(
            max(
                np.abs(trace.history("lower", "motion.position")[:, 0, 2] - 0.5 - lower).max(),
                np.abs(trace.history("upper", "motion.position")[:, 0, 2] - 1.0 - upper).max(),
            )
        )
    assert errors[-1] < size
    assert min(laboratory.orders(errors)) > order
