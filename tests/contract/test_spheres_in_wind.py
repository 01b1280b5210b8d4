"""Spheres of particle_spheres in a creeping flow, over a direct link: exact by exponentials.

Pose, spin and temperature go one way, force, torque and heat come back.
"""

import shutil

import laboratory
import numpy as np
import pytest

from quintet.coupler.report.diff import compare
from quintet.coupler.run import snapshots
from quintet.coupler.run.simulate import make_folder, simulate
from quintet.coupler.scene.read import load

VISCOSITY, CONDUCTIVITY, WIND = 1.8e-5, 0.025, np.array([2.0, 0.0, -1.0])
DENSITY, SIZE, CAPACITY = 1000.0, 1e-4, 800.0  # kg/m3, m, J/(kg K)
RELAXES = DENSITY * SIZE**2 / (18.0 * VISCOSITY)  # s
STOPS = DENSITY * SIZE**2 / (60.0 * VISCOSITY)  # s, of the spin
WARMS = DENSITY * CAPACITY * SIZE**2 / (12.0 * CONDUCTIVITY)  # s
SPIN = np.array([0.0, 30.0, 40.0])  # rad/s
END = 0.6 * STOPS
LINK = {
    "kind": "direct",
    "pairs": [
        ["balls.motion", "wind.motion"],
        ["balls.spheres", "wind.spheres"],
        ["wind.load", "balls.load"],
        ["wind.heat", "balls.heat"],
    ],
}


def _scene(folder, window, ratio=1, scheme="iterated", **settings):
    sphere = {"radius": 0.5 * SIZE, "density": DENSITY, "specific_heat": CAPACITY}
    still = {**sphere, "centre": [0.0, 0.0, 0.0], "angular_velocity": SPIN.tolist()}
    parcel = {**sphere, "centre": [0.0, 1.0, 0.0], "velocity": [0.0, 3.0, 0.0], "parcel": 50.0}
    components = {
        "balls": {
            "kind": "particle_spheres",
            "spheres": [still, parcel],
            "collisions": False,
            "longest_step": window,
        },
        "wind": {
            "kind": "toy_winds:Wind",
            "count": 2,
            "velocity": WIND.tolist(),
            "dt": window / ratio,
        },
    }
    return laboratory.scene(
        folder, components, LINK, end=END, window=window, scheme=scheme, **settings
    )


def _errors(trace):
    """Errors of velocity, spin and temperature at the end, relative to their changes."""
    last = trace.outputs[-1]["balls"]
    first = np.array([[0.0, 0.0, 0.0], [0.0, 3.0, 0.0]])
    velocity = WIND + (first - WIND) * np.exp(-END / RELAXES)
    spin = SPIN * np.exp(-END / STOPS)
    warmth = 400.0 - 100.0 * np.exp(-END / WARMS)
    return [
        float(np.abs(last["spheres.velocity"] - velocity).max()) / 3.0,
        float(np.abs(last["motion.angular_velocity"][0] - spin).max()) / 50.0,
        float(np.abs(last["spheres.temperature"] - warmth).max()) / 100.0,
    ]


def test_velocity_spin_and_temperature_converge_to_the_exact_relaxation(tmp_path):
    errors = [
        _errors(laboratory.couple(_scene(tmp_path, STOPS / n, ratio=2))) for n in (10, 20, 40)
    ]
    assert max(errors[-1]) < 2e-4
    for quantity_errors in zip(*errors, strict=True):
        assert min(laboratory.orders(list(quantity_errors))) > 1.9


@pytest.mark.parametrize("scheme", ["serial", "parallel", "iterated"])
def test_momentum_and_heat_of_spheres_close_to_rounding(tmp_path, scheme):
    account = laboratory.couple(_scene(tmp_path, STOPS / 20.0, 3, scheme)).account
    assert account.momentum_residual <= 1e-12
    assert account.angular_residual <= 1e-12
    assert account.heat_residual <= 1e-12
    assert account.kinematic_residual <= 1e-12


@pytest.mark.zenoh
def test_two_processes_and_a_resumption_give_the_bits_of_one_process(tmp_path, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", str(laboratory.HERE))  # where the toys are
    monkeypatch.setattr(snapshots, "remove", lambda paths: None)
    path = str(_scene(tmp_path, STOPS / 20.0, 3, output={"snapshots": 5.0 * STOPS / 20.0}))
    for transport in ("memory", "zenoh"):
        scene = load(path, transport=transport)
        make_folder(scene, tmp_path / transport)
        assert simulate(scene, tmp_path / transport) == 0
    resumed = tmp_path / "again"
    shutil.copytree(tmp_path / "zenoh", resumed)
    saved_files = sorted(resumed.glob("snapshot-*.h5"), key=snapshots.window_of)
    assert simulate(load(path, transport="zenoh"), resumed, saved_files[0]) == 0
    assert compare(tmp_path / "memory", tmp_path / "zenoh") is None
    assert compare(tmp_path / "memory", resumed) is None
