"""A sphere strikes finite elements: Hertz's law, on faces at rest and on an elastic block."""

import laboratory
import numpy as np
import pytest

STEEL = {"density": 7800.0, "youngs_modulus": 2.1e11, "poissons_ratio": 0.3}
RADIUS, SPEED, GAP = 5e-3, 0.1, 2e-7  # m, m/s, m
EDGE = 5e-3  # m, of elements
MASS = 7800.0 * 4.0 / 3.0 * np.pi * RADIUS**3  # kg
MODULUS = 0.5 * 2.1e11 / (1.0 - 0.3**2)  # Pa, E* of steel on steel
DEEPEST = (15.0 * MASS * SPEED**2 / (16.0 * MODULUS * RADIUS**0.5)) ** 0.4  # m
LARGEST = 4.0 / 3.0 * MODULUS * RADIUS**0.5 * DEEPEST**1.5  # N


def _impact(folder, fixed_z, steps=40):
    """Velocity of a steel sphere that strikes the middle of a steel block, and times."""
    body = {
        "shape": "sphere", "radius": RADIUS, "centre": [0.0, 0.0, RADIUS + GAP], "density": 7800.0,
        "material": "steel", "velocity": [0.0, 0.0, -SPEED],
    }  # fmt: skip
    steel = {"youngs_modulus": 2.1e11, "poissons_ratio": 0.3, "restitution": 1.0, "friction": 0.0}
    sphere = {
        "kind": "dem_bodies", "bodies": [body], "materials": {"steel": steel},
        "contact_with_faces": True, "gravity": [0.0, 0.0, 0.0], "steps_per_contact": steps,
    }  # fmt: skip
    wide = 4.5 * EDGE
    low, high = [-wide, -wide, -6.0 * EDGE], [wide, wide, 0.0]
    block = {
        "kind": "fe_plate", "integration": "reduced", "viscosity_linear": 0.0,
        "parts": [{"lowest": low, "highest": high, "elements": [9, 9, 6], "material": STEEL}],
        "fixed": [{"lowest": low, "highest": [wide, wide, fixed_z], "directions": ["x", "y", "z"]}],
        "coupled_faces": [{"lowest": [-wide, -wide, 0.0], "highest": [wide, wide, 0.0]}],
    }  # fmt: skip
    table = {"kind": "contact", "between": ["sphere", "block"]}
    parts = {"sphere": sphere, "block": block}
    scene = laboratory.scene(folder, parts, table, end=6e-5, order=["sphere", "block"])
    trace = laboratory.couple(scene)
    assert not [text for text in trace.warnings if "sphere" in text]
    velocity = trace.history("sphere", "motion.velocity")[:, 0, 2]
    position = trace.history("sphere", "motion.position")[:, 0, 2]
    return trace, trace.times, velocity, position


# At rest only the law is tested; an elastic block deforms as far as its elements resolve it.
@pytest.mark.parametrize(("fixed_z", "tolerance"), [(0.0, 0.005), (-6.0 * EDGE, 0.02)])
def test_a_sphere_bounces_off_a_block_as_hertz_has_it(tmp_path, fixed_z, tolerance):
    trace, times, velocity, position = _impact(tmp_path, fixed_z)
    force = MASS * np.gradient(velocity, times)
    assert force.max() == pytest.approx(LARGEST, rel=tolerance)
    assert RADIUS - position.min() == pytest.approx(DEEPEST, rel=tolerance)
    # Where the force is half of the largest one, on the way in and out.
    above = np.flatnonzero(force > 0.5 * LARGEST)
    first, last = above[0], above[-1]
    begin, end = (
        np.interp(
            0.5 * LARGEST, *zip(*sorted(zip(force[span], times[span], strict=True)), strict=True)
        )
        for span in (slice(first - 1, first + 1), slice(last, last + 2))
    )
    assert end - begin == pytest.approx(_half_width(), rel=tolerance)
    assert velocity[-1] == pytest.approx(SPEED, rel=tolerance)
    mass = trace.components["sphere"].totals().mass
    assert mass == pytest.approx(MASS)


def _half_width():
    """Time [s] for which Hertz's force is more than half of the largest: of F = F_m x^{3/2}."""
    # dt = δ_m/v dx/√(1 - x^{5/2}), with x = sin^{4/5} u to take out the pole at 1.
    u = np.linspace(np.arcsin(0.5 ** (2.0 / 3.0 * 1.25)), 0.5 * np.pi, 20001)
    rate = 0.8 * np.sin(u) ** (-0.2)
    return 2.0 * DEEPEST / SPEED * float(np.trapezoid(rate, u))
