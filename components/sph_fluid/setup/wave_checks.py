"""What wave makers and damping zones must suit; each mistake is one sentence."""

import math

import numpy as np

from quintet.components.shared.geometry.bounds import Bounds
from quintet.components.sph_fluid.setup.boundary import Boundary
from quintet.components.sph_fluid.setup.geometry import ROUNDING
from quintet.components.sph_fluid.setup.pistons import Piston
from quintet.components.sph_fluid.setup.wave_maker import LEAST_PARTICLES, Waves
from quintet.interfaces.component import Array
from quintet.interfaces.params import Vector

HALF = 0.5  # of a spacing: how far the water of a scene may be from that of the theory
SAME = 1e-6  # of gravity


def check_waves(
    boundary: Boundary, extents: tuple[Bounds, ...], gravity: Vector, spacing: float
) -> None:
    """Wave makers suit the water that they stand in, and stay in its tank."""
    bottom = min(low[2] for low, _ in extents)
    level = max(high[2] for _, high in extents)
    for number, piston in enumerate(boundary.pistons):
        if piston.waves is None:
            continue
        where, waves = f"boundary.pistons[{number}]", piston.waves
        _check_water(where, waves, (bottom, level), gravity, spacing)
        if waves.significant < (LEAST_PARTICLES - ROUNDING) * spacing:
            raise ValueError(
                f"{where}.waves need {LEAST_PARTICLES} particles or more in their height, and 8 or "
                f"more to run far; found {waves.significant / spacing:.3g}. Refine the spacing, or "
                "raise the height."
            )
        if piston.path.turns and piston.number("obstacles") >= 0:
            _check_flap(where, piston, boundary)


def _check_water(
    where: str, waves: Waves, water: tuple[float, float], gravity: Vector, spacing: float
) -> None:
    """The theory is that of the scene's water: `water` has its lowest and highest level [m]."""
    bottom, level = water
    wrong = max(abs(waves.bottom - bottom), abs(waves.level - level))
    if wrong > HALF * spacing:
        raise ValueError(
            f"{where}.waves must have the depth and the bottom of the water, {level - bottom:g} m "
            f"and {bottom:g} m; found {waves.depth:g} m and {waves.bottom:g} m. Correct them."
        )
    if math.hypot(gravity[0], gravity[1], gravity[2] + waves.gravity) > SAME * waves.gravity:
        raise ValueError(
            f"{where}.waves.gravity must be that of the fluid, downwards along z; found "
            f"{waves.gravity:g} m/s2 and {gravity}. Correct one of them."
        )


def _check_flap(where: str, piston: Piston, boundary: Boundary) -> None:
    """A flap that is an obstacle stays in the tank when it leans most."""
    assert piston.waves is not None
    low, high = boundary.solids[piston.number("obstacles")]
    forward, hinge = piston.waves.forward, np.array(piston.waves.point)
    top = max(float(reach) for reach in _heights(low, high, hinge))
    leaning = piston.waves.trajectory.course()[:, 3]
    for face in boundary.closed_faces(3) if boundary.tank else ():
        axis, sign = "xyz".index(face[0]), 1.0 if face[1] == "+" else -1.0
        if axis == 2 or forward[axis] == 0.0:
            continue
        assert boundary.tank is not None
        wall = boundary.tank["-+".index(face[1])][axis]
        side = (high if face[1] == "+" else low)[axis]
        reach = max(0.0, top * float((sign * forward[axis] * np.sin(leaning)).max()))
        if sign * (side - wall) + reach > 0.0:
            raise ValueError(
                f"{where}: {piston.part} must stay in the tank; found that its top goes "
                f"{reach:.3g} m towards the wall {face}, {sign * (wall - side):.3g} m away. Lower "
                "the waves, or move the wall."
            )


def _heights(low: Vector, high: Vector, hinge: Array) -> tuple[float, float]:
    return high[2] - float(hinge[2]), low[2] - float(hinge[2])


def check_damping(
    boundary: Boundary, extents: tuple[Bounds, ...], dimensions: int, spacing: float
) -> None:
    """Damping zones hold water, and point to a side that there is."""
    for number, zone in enumerate(boundary.damping):
        where = f"boundary.damping[{number}]"
        if dimensions == 2 and zone.towards[0] == "y":
            raise ValueError(
                f"{where}.towards must be x-, x+, z- or z+ in two dimensions; found "
                f"{zone.towards}. Correct it."
            )
        axes = (0, 2) if dimensions == 2 else (0, 1, 2)
        lows, highs = np.array([box[0] for box in extents]), np.array([box[1] for box in extents])
        shared = np.minimum(highs, zone.highest) - np.maximum(lows, zone.lowest)  # (boxes, 3) m
        if not (shared[:, axes] > spacing).all(axis=1).any():
            raise ValueError(
                f"{where} must reach into the fluid by more than a spacing; found "
                f"{zone.lowest} to {zone.highest} m. Move it, or remove it."
            )
