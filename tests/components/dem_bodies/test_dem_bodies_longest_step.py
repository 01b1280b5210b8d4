"""The longest stable step of bodies at rest, by the springs and dampers of their contacts."""

import numpy as np
import pytest
from dem_scenes import FLOOR, box, build, material, run, sphere

from quintet.components.dem_bodies.analysis.longest_step import longest_step
from quintet.components.dem_bodies.contact.materials import damping_ratio
from quintet.components.dem_bodies.laws import DAMPING

RADIUS = 0.05


def at_rest(body, **changes):
    keys = {"planes": [FLOOR], "contact_forces": True, "impact_speed": 0.05}
    bodies = build([body], {"a": material(youngs_modulus=1e6, **changes)}, **keys)
    run(bodies, 2.0)
    return bodies


def test_longest_step_of_a_smooth_sphere_is_that_of_an_oscillator():
    """(ω dt)² + 4 γ dt = 4 with ω² = S_n/m = 3/2 g/δ and γ = DAMPING ζ ω."""
    ball = at_rest(sphere([0.0, 0.0, RADIUS], 2.0 * RADIUS), friction=0.0)
    ω = np.sqrt(1.5 * 9.81 / ball.contact_points()["depth"][0])
    γ = DAMPING * damping_ratio(0.5) * ω
    exact = (np.sqrt(4.0 * γ**2 + 4.0 * ω**2) - 2.0 * γ) / ω**2
    assert longest_step(ball) == pytest.approx(exact, rel=1e-6)


@pytest.mark.parametrize(
    "body",
    [sphere([0.0, 0.0, RADIUS], 2.0 * RADIUS), box([0.0, 0.0, 0.075])],
    ids=["rolling sphere", "box"],
)
def test_bodies_at_rest_vibrate_with_steps_beyond_the_longest(body):
    resistance = 0.2 if body["shape"] == "sphere" else 0.0
    grown = []
    for share in (0.97, 1.03):
        bodies = at_rest(body, rolling_friction=resistance)
        step, row = share * longest_step(bodies), bodies.state.row[0]
        bodies.state.velocity[row] += [1e-8, 2e-8, 3e-8]
        sizes = []
        for _ in range(150):
            bodies.step(step)
            sizes.append(float(np.abs(bodies.state.velocity[row]).max()))
        grown.append(max(sizes[-10:]) / max(sizes[:10]))
    assert grown[0] < 0.1 and grown[1] > 5.0
