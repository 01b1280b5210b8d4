"""Checks of wave makers and damping zones; each mistake is one sentence."""

import itertools
import math

import numpy as np

from quintet.components.shared.geometry.bounds import Bounds
from quintet.components.sph_fluid.setup.boundary import Boundary
from quintet.components.sph_fluid.setup.geometry import ROUNDING
from quintet.components.sph_fluid.setup.piston_checks import part_corners
from quintet.components.sph_fluid.setup.pistons import Piston
from quintet.components.sph_fluid.setup.wave_maker import LEAST_PARTICLES, Waves
from quintet.components.sph_fluid.setup.wave_theory import wave_number
from quintet.interfaces.component import Array
from quintet.interfaces.params import Vector

HALF = 0.5  # of a spacing: how far the water of a scene may be from that of the theory
DEEP = 1.5  # kh above which a paddle reflects 0.17 or more of what it should absorb
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
        label, waves = f"boundary.pistons[{number}]", piston.waves
        if boundary.motion is not None:
            raise ValueError(
                f"{label}.waves and boundary.motion do not go together: the theory is for a tank "
                "that stands; found both. Remove one."
            )
        _check_water(label, waves, (bottom, level), gravity, spacing)
        if waves.significant < (LEAST_PARTICLES - ROUNDING) * spacing:
            raise ValueError(
                f"{label}.waves need {LEAST_PARTICLES} particles or more in their height, and 8 or "
                f"more to run far; found {waves.significant / spacing:.3g}. Refine the spacing, or "
                "raise the height."
            )
        corners = part_corners(piston, boundary)
        if corners.size == 0:  # a face of the tank, which is refused with the pistons
            continue
        _check_front(label, waves, corners, extents, spacing)
        _check_height(label, waves, corners, spacing)
        if waves.turns:
            _check_hinge(label, waves, corners, spacing)
            _check_flap(label, piston, boundary, corners)


def _check_water(
    label: str, waves: Waves, water: tuple[float, float], gravity: Vector, spacing: float
) -> None:
    """The theory is that of the scene's water: `water` has its lowest and highest level [m]."""
    bottom, level = water
    difference = max(abs(waves.bottom - bottom), abs(waves.level - level))
    if difference > HALF * spacing:
        raise ValueError(
            f"{label}.waves must have the depth and the bottom of the water, {level - bottom:g} m "
            f"and {bottom:g} m; found {waves.depth:g} m and {waves.bottom:g} m. Correct them."
        )
    if waves.absorption and abs(waves.level - level) > ROUNDING * spacing:
        raise ValueError(
            f"{label}.waves with absorption must have the level of the water exactly, {level:g} m, "
            f"or the paddle takes the difference for a wave; found {waves.level:g} m. Correct it."
        )
    if math.hypot(gravity[0], gravity[1], gravity[2] + waves.gravity) > SAME * waves.gravity:
        raise ValueError(
            f"{label}.waves.gravity must be that of the fluid, downwards along z; found "
            f"{waves.gravity:g} m/s2 and {gravity}. Correct one of them."
        )


def _check_front(
    label: str, waves: Waves, corners: Array, extents: tuple[Bounds, ...], spacing: float
) -> None:
    """Water begins at the front of a paddle with corners (n, 3) m, and there is none behind."""
    forward = waves.forward
    face = float((corners @ forward).max())
    boxes = [np.array(list(itertools.product(*zip(*box, strict=True)))) for box in extents]
    begin = min(float((box @ forward).min()) for box in boxes) - face
    end = max(float((box @ forward).max()) for box in boxes) - face
    reach = (1.0 + ROUNDING) * spacing
    if end <= reach or (begin < -reach and np.count_nonzero(forward) == 1):
        raise ValueError(
            f"{label}.waves need water in front of the paddle along heading {waves.heading}, and "
            f"none behind; found it from {begin:.3g} to {end:.3g} m from the paddle's face. Turn "
            "heading, or move the paddle or the water."
        )
    if begin > reach:
        raise ValueError(
            f"{label}.waves need water within a spacing of the paddle's face, {spacing:g} m; found "
            f"it {begin:.3g} m away along heading {waves.heading}. Move the paddle or the water."
        )


def _check_height(label: str, waves: Waves, corners: Array, spacing: float) -> None:
    """A paddle reaches from the bed, or from its hinge above that, to above the waves."""
    low, high = float(corners[:, 2].min()), float(corners[:, 2].max())
    base, top = max(waves.bottom, waves.point[2] if waves.turns else -math.inf), waves.level
    tolerance = ROUNDING * spacing
    top += waves.significant
    if low > base + tolerance or high < top - tolerance:
        raise ValueError(
            f"{label}: the paddle must reach from {base:g} m, the bed or a hinge above it, to a "
            f"height of waves above still water, {top:.4g} m; found it from {low:g} to {high:g} m. "
            "Make it higher, or lower the waves."
        )


def _check_hinge(label: str, waves: Waves, corners: Array, spacing: float) -> None:
    """A flap's hinge is in the flap, and no part of the flap is in water below it."""
    coordinates, hinge = corners @ waves.forward, float(np.array(waves.point) @ waves.forward)
    low, high, tolerance = float(coordinates.min()), float(coordinates.max()), ROUNDING * spacing
    if not low - tolerance <= hinge <= high + tolerance:
        raise ValueError(
            f"{label}.waves.hinge must be within the paddle along heading, from {low:g} to "
            f"{high:g} m; found {hinge:g} m. Move the hinge."
        )
    foot, height = float(corners[:, 2].min()), waves.point[2]
    if height > waves.bottom + tolerance and foot < height - (1.0 + ROUNDING) * spacing:
        raise ValueError(
            f"{label}: a flap must end at its hinge where that is above the bed, at {height:g} m: "
            f"below, the theory has a wall that stands; found the flap down to {foot:g} m. Shorten "
            "it, or lower the hinge to the bed."
        )


def _check_flap(label: str, piston: Piston, boundary: Boundary, corners: Array) -> None:
    """A flap with corners (n, 3) m stays in the tank when it leans most."""
    assert piston.waves is not None
    low, high = corners.min(axis=0), corners.max(axis=0)
    forward = piston.waves.forward
    top = float(high[2]) - piston.waves.point[2]
    leaning = piston.waves.trajectory.course()[:, 3]
    for face in boundary.closed_faces(3) if boundary.tank else ():
        axis, sign = "xyz".index(face[0]), 1.0 if face[1] == "+" else -1.0
        if axis == 2 or forward[axis] == 0.0:
            continue
        assert boundary.tank is not None
        wall = boundary.tank["-+".index(face[1])][axis]
        side = float((high if face[1] == "+" else low)[axis])
        reach = max(0.0, top * float((sign * forward[axis] * np.sin(leaning)).max()))
        if sign * (side - wall) + reach > 0.0:
            raise ValueError(
                f"{label}: {piston.part} must stay in the tank; found that its top goes "
                f"{reach:.3g} m towards the wall {face}, {sign * (wall - side):.3g} m away. Lower "
                "the waves, or move the wall."
            )


def absorption_notes(boundary: Boundary) -> tuple[str, ...]:
    """Notes about paddles that absorb waves for which their law is poor."""
    notes = []
    for number, piston in enumerate(boundary.pistons):
        if piston.waves is None or not piston.absorbs:
            continue
        waves = piston.waves
        omega = 2.0 * math.pi / waves.longest_period
        kh = wave_number(omega, waves.depth, waves.gravity) * waves.depth
        if kh > DEEP:
            notes.append(
                f"boundary.pistons[{number}].waves.absorption is made for long waves: with kh "
                f"(wave number · depth) above {DEEP:g}, here {kh:.3g}, the paddle reflects 17 % or "
                "more of the waves that reach it"
            )
    return tuple(notes)


def check_damping(
    boundary: Boundary, extents: tuple[Bounds, ...], dimensions: int, spacing: float
) -> None:
    """Damping zones hold water, and point to a side that there is."""
    for number, zone in enumerate(boundary.damping):
        label = f"boundary.damping[{number}]"
        if dimensions == 2 and zone.towards[0] == "y":
            raise ValueError(
                f"{label}.towards must be x-, x+, z- or z+ in two dimensions; found "
                f"{zone.towards}. Correct it."
            )
        axes = (0, 2) if dimensions == 2 else (0, 1, 2)
        lows, highs = np.array([box[0] for box in extents]), np.array([box[1] for box in extents])
        overlap = np.minimum(highs, zone.highest) - np.maximum(lows, zone.lowest)  # (boxes, 3) m
        if not (overlap[:, axes] > spacing).all(axis=1).any():
            raise ValueError(
                f"{label} must reach into the fluid by more than a spacing; found "
                f"{zone.lowest} to {zone.highest} m. Move it, or remove it."
            )
