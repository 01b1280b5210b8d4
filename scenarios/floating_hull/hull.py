"""The hull and its hydrostatics: ``python scenarios/floating_hull/hull.py`` writes hull.stl.

A double-ended hull with a flat deck, equal fore and aft, so that it floats upright and
without trim. Sections are superellipses, whose half-breadth and depth shrink towards the ends:

    |y / b(x)|^P + |z / d(x)|^P = 1,    b = B/2 (1 - ξ⁴)^½,    d = D (1 - ξ⁴)^½,    ξ = 2x/L.

What the triangles displace below a level h is exact: the flux of (0, 0, z - h) through what of them
is below it, since that field has no flux through the water plane and a divergence of 1.
"""

from pathlib import Path

import numpy as np
import trimesh
from numpy.typing import NDArray

Array = NDArray[np.float64]

LENGTH, BREADTH, DEPTH = 0.48, 0.24, 0.16  # m
POWER = 2.5  # P
STATIONS, POINTS = 21, 13  # along the hull; from one side of the deck to the other
DENSITY, WATER = 550.0, 1000.0  # kg/m3
TANK = 0.72 * 0.48  # m2
FILLED = 0.24  # m, of the water, in which the hull takes its place at the start
START = 0.31  # m, of the deck
FILE = Path(__file__).with_name("hull.stl")


def triangles() -> Array:
    """Corners (t, 3, 3) m of the hull's triangles, the deck at z = 0, seen from outside."""
    ξ = -np.cos(np.linspace(0.0, np.pi, STATIONS))[1:-1]
    taper = np.sqrt(1.0 - ξ**4)[:, None]
    angle = np.linspace(np.pi, 0.0, POINTS)  # so that triangles look outwards
    across = np.sign(np.cos(angle)) * np.abs(np.cos(angle)) ** (2.0 / POWER)
    down = -(np.sin(angle) ** (2.0 / POWER))
    across[np.abs(across) < 1e-9], down[[0, -1]] = 0.0, 0.0
    rings = np.stack(
        [
            np.broadcast_to(0.5 * LENGTH * ξ[:, None], (len(ξ), POINTS)),
            0.5 * BREADTH * taper * across,
            DEPTH * taper * down,
        ],
        axis=-1,
    )
    quads = [
        np.stack([rings[:-1, :-1], rings[:-1, 1:], rings[1:, 1:], rings[1:, :-1]], axis=2).reshape(
            -1, 4, 3
        ),  # the skin
        np.stack([rings[:-1, -1], rings[:-1, 0], rings[1:, 0], rings[1:, -1]], axis=1),  # the deck
    ]
    corners = np.concatenate(quads)
    parts = [corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]]
    for end, ring in ((-1.0, rings[0, ::-1]), (1.0, rings[-1])):
        tip = np.broadcast_to([end * 0.5 * LENGTH, 0.0, 0.0], (POINTS, 3))
        parts.append(np.stack([tip, ring, np.roll(ring, -1, axis=0)], axis=1))
    return np.concatenate(parts)


def below(corners: Array, level: float) -> Array:
    """Triangles (t, 3, 3) m of what of triangles is below a level [m]."""
    height = corners[:, :, 2] - level
    parts = [corners[(height <= 0.0).all(axis=1)]]
    for triangle, rise in zip(corners, height, strict=True):
        under = rise <= 0.0
        if not 0 < under.sum() < 3:
            continue
        k = int(np.flatnonzero(under == (under.sum() == 1))[0])  # the corner apart
        p, q, r = triangle[k], triangle[k - 2], triangle[k - 1]
        to_q = p + rise[k] / (rise[k] - rise[k - 2]) * (q - p)
        to_r = p + rise[k] / (rise[k] - rise[k - 1]) * (r - p)
        pieces = [[p, to_q, to_r]] if under.sum() == 1 else [[to_q, q, r], [to_q, r, to_r]]
        parts.append(np.array(pieces))
    return np.concatenate(parts)


def displaced(corners: Array, level: float) -> tuple[float, float]:
    """Volume [m3] that a hull displaces below a level [m], and the area [m2] of its water plane."""
    wet = below(corners, level)
    area = 0.5 * np.cross(wet[:, 1] - wet[:, 0], wet[:, 2] - wet[:, 0])[:, 2]
    return float((area * (wet[:, :, 2].mean(axis=1) - level)).sum()), -float(area.sum())


def rest(corners: Array, density: float) -> tuple[float, float, float]:
    """Draught [m], displaced volume [m3] and area [m2] of the water plane at rest, by halving.

    Of any closed surface that floats upright, by its corners (t, 3, 3) m.

    Raises
    ------
    ValueError
        Its triangles look inwards, or it does not float.
    """
    keel, deck = float(corners[:, :, 2].min()), float(corners[:, :, 2].max())
    whole = displaced(corners, deck)[0]
    if whole <= 0.0:
        raise ValueError(
            f"triangles must look outwards; the surface encloses {whole:.4g} m3. Flip them."
        )
    if not 0.0 < density < WATER:
        raise ValueError(
            f"what floats has a density between 0 and {WATER:g} kg/m3; found {density:.4g}. "
            "Correct its mass, or the scale of its file."
        )
    volume = whole * density / WATER
    low, high = keel, deck
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if displaced(corners, middle)[0] < volume else (low, middle)
    return low - keel, volume, displaced(corners, low)[1]


def metacentric_height(corners: Array, level: float, centre: float) -> float:
    """Transverse metacentric height GM [m]: above 0 the hull floats upright.

    Parameters
    ----------
    corners : (t, 3, 3) float array, m
        Of a closed surface whose middle plane is y = 0.
    level : float, m
        Of the water.
    centre : float, m
        Height of the centre of mass.

    Notes
    -----
    BM = ∫ y² dA / V over the water plane. This integral and the height of the centre of buoyancy
    are fluxes of (0, 0, y²) and (0, 0, (z - h)²/2) through the wet triangles.
    """
    wet = below(corners, level)
    area = 0.5 * np.cross(wet[:, 1] - wet[:, 0], wet[:, 2] - wet[:, 0])[:, 2]

    def squares(values: Array) -> Array:
        """Mean square over each triangle, of values (t, 3) at its corners."""
        return ((values**2).sum(axis=1) + values.sum(axis=1) ** 2) / 12.0

    volume = displaced(corners, level)[0]
    second_moment = -float((area * squares(wet[:, :, 1])).sum())  # m4
    buoyancy = level + 0.5 * float((area * squares(wet[:, :, 2] - level)).sum()) / volume
    return buoyancy + second_moment / volume - centre


def main() -> None:
    """Write the hull, and print what it displaces."""
    mesh = trimesh.Trimesh(
        triangles().reshape(-1, 3), np.arange(3 * len(triangles())).reshape(-1, 3)
    )
    mesh.merge_vertices()
    mesh.export(FILE)
    corners = np.asarray(trimesh.load_mesh(FILE).triangles, np.float64)
    draught, volume, area = rest(corners, DENSITY)
    removed, _ = displaced(corners, FILLED - START)
    level = FILLED + (volume - removed) / TANK
    centre = float(mesh.center_mass[2]) + DEPTH  # above the keel
    height = level - draught + centre
    # The level falls by `area` as the hull rises by `TANK - area`.
    slope = area * TANK / (TANK - area)
    print(f"{len(corners)} triangles of {displaced(corners, 0.0)[0]:.6g} m3")
    print(f"at rest: draught {draught:.4f} m, displaced {volume:.6g} m3, water plane {area:.5g} m2")
    print(
        f"level {level:.5f} m, centre of mass at z = {height:.5f} m, at the start higher by",
        end=" ",
    )
    print(f"{START - DEPTH + centre - height:.4f} m, where {removed:.6g} m3 of water are removed")
    print(f"displaced volume = -{slope:.5g} m2 (z - {height + volume / slope:.6f} m)")


if __name__ == "__main__":
    main()
