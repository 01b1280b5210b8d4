"""Frequencies of beams and plates of elements with eight points, against thin beams and plates."""

import numpy as np
import pytest

from quintet.components.fe_plate.component import FePlate
from quintet.components.fe_plate.meshes.params import Part
from quintet.components.fe_plate.meshes.selections import Fixed
from quintet.components.fe_plate.params import FePlateParams
from quintet.components.shared.materials.params import Material

E, RHO = 7e10, 2700.0
CALM = {"viscosity_linear": 0.0, "viscosity_quadratic": 0.0}


def structure(size, elements, fixed, poissons_ratio):
    material = Material(density=RHO, youngs_modulus=E, poissons_ratio=poissons_ratio)
    part = Part(lowest=(0.0, 0.0, 0.0), highest=size, elements=elements, material=material)
    return FePlate(FePlateParams(parts=(part,), fixed=fixed, integration="full", **CALM))


def frequencies(plate, count, displacement=1e-9):
    """Lowest frequencies [Hz] of a structure: of M⁻¹K, with K found column by column."""
    free = np.flatnonzero(plate.model.free.ravel() > 0.0)
    root = np.repeat(np.sqrt(plate.model.inverse_mass), 3)[free]
    state, dt = plate.save(), 1e-12
    stiffness = np.empty((len(free), len(free)))
    for column, degree in enumerate(free):
        plate.load(state)
        plate.state.velocity.ravel()[degree] = displacement / dt
        plate.state.internal[:] = 0.0
        plate.step(dt)
        stiffness[:, column] = -plate.state.internal.ravel()[free] / displacement
    plate.load(state)
    assert np.abs(stiffness - stiffness.T).max() < 1e-6 * np.abs(stiffness).max()
    squares = np.linalg.eigvalsh(root[:, None] * 0.5 * (stiffness + stiffness.T) * root)
    return np.sqrt(squares[:count]) / (2.0 * np.pi)


def cantilever(elements, length=0.5, height=0.01):
    """First three frequencies of a cantilever that bends in one plane, one element high."""
    size = (length, height, height)
    fixed = (
        Fixed(lowest=(0.0, 0.0, 0.0), highest=(0.0, height, height)),
        Fixed(lowest=(0.0, 0.0, 0.0), highest=size, directions=("y",)),
    )
    return frequencies(structure(size, (elements, 1, 1), fixed, 0.0), 3)


def test_a_cantilever_has_its_first_three_frequencies():
    """Euler and Bernoulli: β² = 3.5160, 22.034, 61.697; shear and rotation take 0.6 % of the third.

    On meshes halved twice the changes are as those of an error of second order.
    """
    coarse, middle, fine = (cantilever(n) for n in (10, 20, 40))
    thin = np.array([3.5160, 22.034, 61.697]) / (2.0 * np.pi * 0.5**2)
    thin *= np.sqrt(E * 0.01**2 / 12.0 / RHO)
    assert middle == pytest.approx(thin, rel=0.01)
    assert fine == pytest.approx(thin, rel=0.01)
    ratio = (middle - coarse) / (fine - middle)
    assert ((3.0 < ratio) & (ratio < 6.0)).all()


def test_a_simply_supported_plate_has_its_first_three_frequencies():
    """Kirchhoff: f = π/2 (m² + n²)/a² √(D/ρh), one element through the thickness."""
    a, h = 1.0, 0.02
    sides = (((0.0, 0.0), (0.0, a), "y"), ((a, 0.0), (a, a), "y"))
    sides += (((0.0, 0.0), (a, 0.0), "x"), ((0.0, a), (a, a), "x"))
    fixed = tuple(
        Fixed(lowest=(*low, 0.0), highest=(*high, h), directions=(along, "z"))
        for low, high, along in sides
    )
    lowest = frequencies(structure((a, a, h), (12, 12, 1), fixed, 0.3), 3)
    rigidity = E * h**3 / 12.0 / (1.0 - 0.3**2)
    thin = 0.5 * np.pi * np.sqrt(rigidity / (RHO * h)) / a**2 * np.array([2.0, 5.0, 5.0])
    assert lowest == pytest.approx(thin, rel=0.01)
