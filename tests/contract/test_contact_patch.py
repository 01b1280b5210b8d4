"""Patch test of contact: a flat block presses flat faces evenly, on any mesh."""

import laboratory
import numpy as np
import pytest

SOFT = {"density": 1000.0, "youngs_modulus": 1e5, "poissons_ratio": 0.3}
SPACING, SPEED, GAP = 0.1, 0.02, 1e-4  # m, m/s, m
WIDE, LONG = 12, 20  # spacings
C = (1e5 * 0.7 / (1.3 * 0.4) / 1000.0) ** 0.5  # m/s, of longitudinal waves


def _mean_pressures(folder, across, wide, planar, points):
    """Mean pressures of the elements behind the faces while two equal bars push each other.

    Nothing strains sideways, and the pressure is ρ c v/2 everywhere.
    """
    edge, length = wide * SPACING, LONG * SPACING
    deep = 1.0 if planar else edge
    sides = ("x",) if planar else ("x", "y")
    low, high = [0.0, 0.0, GAP], [edge, deep, GAP + length]
    body = {"lowest": low, "highest": high, "material": SOFT, "velocity": [0.0, 0.0, -SPEED]}
    block = {
        "kind": "sph_solid", "spacing": SPACING, "contact_with_faces": True, "bodies": [body],
        "dimensions": 2 if planar else 3,
        "symmetry": [
            {"axis": axis, "position": place, "side": side}
            for axis in sides for side, place in (("+", 0.0), ("-", edge))
        ],
    }  # fmt: skip
    count = [across, 1 if planar else across, LONG]
    low, high = [0.0, 0.0, -length], [edge, deep, 0.0]
    middles = (np.arange(across) + 0.5) * edge / across
    along_y = [0.5] if planar else middles
    places = [[float(x), float(y), -0.5 * SPACING] for x in middles for y in along_y]
    slab = {
        "kind": "fe_plate", "dimensions": block["dimensions"], "integration": "reduced",
        "parts": [{"lowest": low, "highest": high, "elements": count, "material": SOFT}],
        "fixed": [{"lowest": low, "highest": high, "directions": list(sides)}],
        "coupled_faces": [{"lowest": [0.0, 0.0, 0.0], "highest": high}],
        "gauges": {"element_gauges": places}, "viscosity_linear": 0.0, "viscosity_quadratic": 0.0,
    }  # fmt: skip
    transit = length / C
    end = GAP / SPEED + 1.8 * transit
    table = {"kind": "contact", "between": ["slab", "block"], "points_across": points}
    scene = laboratory.scene(
        folder, {"block": block, "slab": slab}, table, end=end, order=["block", "slab"]
    )
    trace = laboratory.couple(scene)
    pressure = trace.history("slab", "element_gauge.pressure")
    return pressure[trace.times > GAP / SPEED + 0.3 * transit].mean(axis=0)


# In two dimensions and in three, with particles that do and do not divide the faces.
@pytest.mark.parametrize(
    ("across", "wide", "planar", "points"),
    [(12, 12, True, 1), (4, 12, True, 1), (7, 12, True, 3), (5, 12, True, 3), (4, 6, False, 3)],
)
def test_every_face_bears_the_same_pressure(tmp_path, across, wide, planar, points):
    pressure = _mean_pressures(tmp_path, across, wide, planar, points)
    assert np.abs(pressure / pressure.mean() - 1.0).max() < 0.01
    longitudinal, bulk = 1000.0 * C**2, 1e5 / (3.0 * 0.4)
    exact = bulk / longitudinal * 1000.0 * C * SPEED / 2.0
    assert pressure.mean() == pytest.approx(exact, rel=0.02)
