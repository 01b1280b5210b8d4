"""Small scenes for the tests of rigid bodies."""

import math
from decimal import Decimal

import numpy as np

from quintet.components.dem_bodies.component import DemBodies
from quintet.components.dem_bodies.params import DemBodiesParams
from quintet.interfaces.component import Resources
from quintet.interfaces.params import read

GLASS = {"youngs_modulus": 4.8e10, "poissons_ratio": 0.2, "restitution": 1.0, "friction": 0.0}
PLASTIC = {"youngs_modulus": 3.0e9, "poissons_ratio": 0.3, "restitution": 0.6, "friction": 0.45}
STEEL = {"youngs_modulus": 2.1e11, "poissons_ratio": 0.3, "restitution": 0.8, "friction": 0.35}
FLOOR = {"point": [0.0, 0.0, 0.0], "normal": [0.0, 0.0, 1.0], "material": "a"}
NOTHING = [0.0, 0.0, 0.0]


def material(**changes):
    return {
        "youngs_modulus": 1e8,
        "poissons_ratio": 0.3,
        "restitution": 0.5,
        "friction": 0.3,
    } | changes


def sphere(position, diameter=0.02, **properties):
    defaults = {"shape": "sphere", "radius": 0.5 * diameter, "density": 2500.0, "material": "a"}
    return defaults | {"centre": list(position)} | properties


def box(position, size=(0.15, 0.15, 0.15), **properties):
    defaults = {"shape": "box", "density": 800.0, "material": "a"}
    return defaults | corners(position, size) | properties


def _decimal(number):
    return Decimal(repr(float(number)))


def corners(position, size):
    """Corners of a box around its centre; the decimal numbers give exactly that size and centre."""
    pairs = list(zip(map(_decimal, position), map(_decimal, size), strict=True))
    low, high = [float(x - s / 2) for x, s in pairs], [float(x + s / 2) for x, s in pairs]
    return {"lowest": low, "highest": high}


def disc(position, diameter=0.2, **properties):
    defaults = {"shape": "disc", "radius": 0.5 * diameter, "density": 1000.0, "material": "a"}
    return defaults | {"centre": list(position)} | properties


def polygon(position, corners, **properties):
    defaults = {"shape": "polygon", "corners": corners, "density": 800.0, "material": "a"}
    return defaults | {"origin": list(position)} | properties


def rectangle(position, width=0.15, height=0.15, **properties):
    x, z = 0.5 * width, 0.5 * height
    return polygon(position, [[-x, -z], [x, -z], [x, z], [-x, z]], **properties)


def params(bodies, materials=None, **settings):
    scene = {"bodies": bodies, "materials": {"a": material()} if materials is None else materials}
    parsed, mistakes = read(DemBodiesParams, scene | settings, "bodies")
    assert not mistakes, mistakes
    return parsed


def mistakes(bodies, **settings):
    scene = {"bodies": bodies, "materials": {"a": material()}} | settings
    return read(DemBodiesParams, scene, "bodies")[1]


def build(bodies, materials=None, threads=1, **settings):
    """Bodies before the first step of a run, with their contacts listed."""
    solver = DemBodies(params(bodies, materials, **settings), Resources(threads))
    solver.stable_dt()
    return solver


def run(component, end, watch=None, dt=None):
    """Step until a time; `watch` sees every step."""
    time = 0.0
    while time < end * (1.0 - 1e-12):
        step = min(dt or component.stable_dt(), end - time)
        component.step(step)
        time += step
        if watch is not None:
            watch(time)


def three_cubes():
    """The cubes of the dam break, on its floor."""
    bodies = [box([5.275, 0.35, z]) for z in (0.075, 0.225, 0.375)]
    floor = FLOOR | {"material": "floor"}
    return build(bodies, {"a": PLASTIC, "floor": STEEL}, planes=[floor], impact_speed=3.0)


def about(axis, angle):
    """Quaternion of a turn about an axis."""
    unit = np.array(axis) / np.linalg.norm(axis)
    return [math.cos(0.5 * angle), *(math.sin(0.5 * angle) * unit).tolist()]


def energy(component):
    totals = component.totals()
    return totals.kinetic + totals.potential + totals.internal
