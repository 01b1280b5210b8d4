"""The linearised step has the limits that von Neumann's analysis of a lattice gives."""

import itertools

import numpy as np
import pytest

from quintet.components.shared.smoothing.smoothing import gradient, smoothing
from quintet.components.sph_solid.analysis.linear_step import largest_courant
from quintet.components.sph_solid.component import SphSolid
from quintet.components.sph_solid.params import SphSolidParams
from quintet.interfaces.params import read

SPACING, SMOOTHING = 1e-3, 1.2
STEEL = {"density": 7800.0, "youngs_modulus": 2e11, "poissons_ratio": 0.3}


def strip(linear: float) -> SphSolid:
    """A strip at rest, three particles wide between planes of symmetry."""
    table = {
        "spacing": SPACING,
        "dimensions": 2,
        "viscosity_linear": linear,
        "viscosity_quadratic": 0.0,
        "total_lagrangian": False,
        "kernel_correction": False,
        "bodies": [{"lowest": [0, 0, 0], "highest": [3e-3, 1, 0.012], "material": STEEL}],
        "symmetry": [{"axis": "x"}, {"axis": "x", "position": 3e-3, "side": "-"}],
    }
    params, mistakes = read(SphSolidParams, table, "strip")
    assert not mistakes, mistakes
    return SphSolid(params)


def lattice_limit(linear: float) -> float:
    """Courant number at which the steepest wave of a lattice changes its sign at every step.

    With K of the stresses and D of all pairs' viscosity, of which half act at a time and whose
    velocities are predicted as v + ½ (v - v₋): dt² K + 2 dt D has the eigenvalue 4. Speed of
    sound and smoothing length are the units.
    """
    h, cell = SMOOTHING * SPACING, np.arange(-3, 4) * SPACING
    offset = np.array([(x, z) for x in cell for z in cell if x or z])  # (n, 2) m
    r2, law = (offset * offset).sum(axis=1), smoothing("cubic", 2, h)
    weight = np.array([gradient.py_func(s, 1.0 / np.sqrt(s), law) for s in r2]) * SPACING**2
    shear = (1.0 - 2.0 * 0.3) / (2.0 - 2.0 * 0.3)  # square of both sounds' ratio
    limits = []
    for i, k in itertools.product(range(4), np.linspace(0.0, 1.0, 60)):  # waves between the planes
        phase = offset @ (np.array([i / 3.0, k]) * np.pi / SPACING)
        g = h * (weight * np.sin(phase)) @ offset
        stiffness = np.outer(g, g) + shear * ((g @ g) * np.eye(2) - np.outer(g, g))
        rates = -linear * h * h * weight * (1.0 - np.cos(phase)) / (r2 + 0.01 * h * h)
        drag = np.einsum("j,ja,jb->ab", rates, offset, offset)
        steps = np.linspace(0.1, 4.0, 400)[:, None, None]
        most = np.linalg.eigvalsh(steps**2 * stiffness + 2.0 * steps * drag)[:, 1]
        limits.append(float(np.interp(4.0, most, steps[:, 0, 0])))
    return min(limits) * (1.0 + 1.2 * linear)


@pytest.mark.parametrize("linear", [0.0, 1.0])
def test_a_lattice_at_rest_is_stable_up_to_the_limit_of_its_steepest_wave(linear: float) -> None:
    assert largest_courant(strip(linear)) == pytest.approx(lattice_limit(linear), rel=0.03)
