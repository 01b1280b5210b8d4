"""Small bodies of particles, and the same bodies on the processor and on a device."""

import numpy as np
import pytest

from quintet.components.sph_solid.params import SphSolidParams
from quintet.interfaces.component import Resources
from quintet.interfaces.params import read

DEVICE = Resources(device="opencl")
SPACING = 0.01  # m
BRITTLE = {
    "density": 7830.0,
    "youngs_modulus": 2.07e11,
    "poissons_ratio": 0.3,
    "specific_heat": 460.0,
    "johnson_cook": {
        "a": 8e8, "b": 5e8, "n": 0.17, "c": 0.009, "m": 1.1, "melting_temperature": 1813.0,
    },
    "damage": {"d1": 0.05, "d2": 0.3, "d3": -1.5, "d4": 0.01, "d5": 0.5},
}  # fmt: skip


def blocks(materials, velocity, **changes):
    """Table of two blocks, of which the second strikes the first."""
    still, moving = materials
    bodies = [
        {"lowest": [0.0, 0.0, 0.0], "highest": [0.05, 0.04, 0.04], "material": still},
        {
            "lowest": [0.05, 0.0, 0.0],
            "highest": [0.08, 0.04, 0.04],
            "material": moving,
            "velocity": velocity,
        },
    ]
    return {"spacing": SPACING, "bodies": bodies} | changes


METALS = ("steel", "aluminium")
RUBBER = {"density": 1000.0, "youngs_modulus": 1e7, "poissons_ratio": 0.4}
FAST = blocks(METALS, [-3000.0, 20.0, 10.0])
CORRECTED = blocks(
    METALS, [-300.0, 20.0, 10.0], kernel_correction=True, symmetry=[{"axis": "y"}, {"axis": "z"}]
)
TORN = blocks((BRITTLE, BRITTLE), [-700.0, 20.0, 10.0], symmetry=[{"axis": "z"}])
PLANAR = blocks(METALS, [-500.0, 0.0, 0.0], dimensions=2, gravity=[0.0, 0.0, -1e6])
HELD = FAST | {
    "fixed": [{"lowest": [0.0, 0.0, 0.0], "highest": [0.01, 1.0, 1.0], "directions": ["x", "z"]}],
    "gravity": [1e5, 0.0, 1e5],
}
GLUED = CORRECTED | {"glued": [{"lowest": [0.0, 0.0, 0.0], "highest": [0.01, 1.0, 1.0]}]}
RINGS = {
    "spacing": SPACING,
    "dimensions": 2,
    "axisymmetric": True,
    "bodies": [
        {
            "shape": "sphere", "centre": [0.0, 0.0, 0.03], "radius": 0.03, "material": "aluminium",
            "velocity": [0.0, 0.0, -3000.0],
        },
        {"lowest": [0.0, 0.0, -0.04], "highest": [0.1, 1.0, 0.0], "material": "steel"},
    ],
}  # fmt: skip
CORRECTED_RINGS = RINGS | {
    "kernel_correction": True,
    "symmetry": [{"axis": "z"}],
    "bodies": [
        {
            "lowest": [0.0, 0.0, 0.0], "highest": [0.05, 1.0, 0.05], "material": "42CrMo4",
            "velocity": [0.0, 0.0, -287.0],
        },
    ],
}  # fmt: skip
# Bodies with the neighbours of the start: rubber that strikes, and meets a plane later; a bar and a
# plate that move alike, and are one, struck by a block; metal that yields.
MEETING = blocks(
    (RUBBER, RUBBER),
    [-20.0, 1.0, 0.5],
    symmetry=[{"axis": "z"}, {"axis": "x", "position": -0.0061}],
)
JOINED = {
    "spacing": SPACING,
    "dimensions": 2,
    "gravity": [0.0, 0.0, -1e3],
    "viscosity_linear": 0.2,
    "bodies": [
        {"lowest": [0.0, 0.0, 0.0], "highest": [0.08, 1.0, 0.02], "material": RUBBER},
        {"lowest": [0.02, 0.0, 0.02], "highest": [0.04, 1.0, 0.06], "material": RUBBER},
        {
            "lowest": [0.05, 0.0, 0.025], "highest": [0.08, 1.0, 0.045], "material": RUBBER,
            "velocity": [-10.0, 0.0, -10.0],
        },
    ],
}  # fmt: skip
REPELLED = blocks(
    (RUBBER, RUBBER), [20.0, 1.0, 0.5], artificial_stress=0.3, symmetry=[{"axis": "z"}]
)
YIELDING = blocks(METALS, [-300.0, 20.0, 10.0], total_lagrangian=True)
READ = {"gauges": [[0.05, 0.0, 0.0]], "levels": [{"body": 0, "place": [0.02, 0.02]}]}


def params_of(table):
    params, mistakes = read(SphSolidParams, table, "solid")
    assert not mistakes, mistakes
    return params


def advanced(solid, steps):
    for _ in range(steps):
        solid.step(solid.stable_dt())
    return solid


def by_birth(saved, name):
    """An array of particles in the order of their birth."""
    return saved[name][np.argsort(saved["identity"])]


def difference(first, second, name):
    """Largest difference of two saved states in an array of particles, over its largest number."""
    a, b = by_birth(first, name), by_birth(second, name)
    return np.abs(a - b).max() / max(np.abs(a).max(), 1e-300)


def differing(first, second):
    """Names of the arrays of two saved states that have other bits."""
    assert first.keys() == second.keys()
    return [name for name in first if not np.array_equal(first[name], second[name], equal_nan=True)]


NAMES = ("position", "velocity", "energy", "strain", "temperature", "damage", "density_ratio")


def require_close(processor, device, limit=1e-11):
    """Require that two solids are alike to a share of the largest numbers."""
    first, second = processor.save(), device.save()
    assert first.keys() == second.keys()
    assert np.array_equal(first["identity"], second["identity"])  # sorted alike
    assert np.array_equal(first["failed"], second["failed"])
    assert device.stable_dt() == pytest.approx(processor.stable_dt(), rel=limit)
    assert {name: difference(first, second, name) for name in NAMES} == pytest.approx(
        dict.fromkeys(NAMES, 0.0), abs=limit
    )
