"""Two bodies as heavy as water under it, each link with a contact of its own: both stay."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from quintet.coupler.files.recording import Recording

Run = Callable[..., dict]

SCENE = str(Path(__file__).parent / "two_contacts.toml")
G, END = 9.81, 0.15  # m/s2, s


@pytest.fixture(scope="module")
def results(run_scene: Run) -> dict:
    return run_scene(SCENE, "--set", f"end={END}")


@pytest.mark.parametrize("body", ["left", "right"])
def test_a_body_as_heavy_as_water_feels_no_net_force(results: dict, body: str) -> None:
    with Recording(results["folder"]) as recording:
        place = recording.history(body, "motion.position", 0)
        velocity = recording.history(body, "motion.velocity", 0)
    # Mean force on it over the time so far, over its weight, as soon as sound has passed.
    time = np.linspace(0.0, END, len(velocity))[:, None]
    late = len(velocity) // 3
    assert np.abs(velocity[late:] / (G * time[late:])).max() < 0.01
    assert np.abs(place - place[0]).max() < 1e-3  # m, a thirtieth of a spacing


def test_each_link_has_the_contact_that_it_asks_for(results: dict) -> None:
    # In this tank two bodies of the same contact would be mirror images of each other.
    with Recording(results["folder"]) as recording:
        left, right = (recording.history(body, "motion.position", 0) for body in ("left", "right"))
    assert np.abs(left[:, 2] - right[:, 2]).max() > 1e-5  # m
    for link in results["ledger"]["links"]:
        assert link["momentum_residual"] < 1e-12, link
