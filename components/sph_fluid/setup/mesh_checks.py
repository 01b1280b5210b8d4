"""Checks of boundaries from files; imported only by a scene that has some."""

from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from quintet.components.shared.geometry.bounds import Bounds
from quintet.components.shared.geometry.lattice import fill_box
from quintet.components.sph_fluid.setup.boundary import Boundary
from quintet.components.sph_fluid.setup.boundary_meshes import Filling
from quintet.components.sph_fluid.setup.geometry import cells
from quintet.components.sph_fluid.setup.mesh_points import mesh_points, surface
from quintet.components.sph_fluid.setup.mesh_surfaces import FAR, Surface
from quintet.components.sph_fluid.setup.shape_filling import fill_shape
from quintet.components.sph_fluid.setup.shapes import Fluid
from quintet.interfaces.component import Array
from quintet.interfaces.params import Vector

THIN = 2.0  # spacings that what is behind a surface must be thick
APART = 0.25  # spacings that fluid must be before a surface: nearer, it is thrown away from it
NEAR = 0.5  # spacings between wall particles of two surfaces that do not overlap


def check_meshes(
    boundary: Boundary,
    filling: Filling,
    dimensions: int,
    fluid: Iterable[Array],
    gauges: Sequence[tuple[str, Vector]],
) -> None:
    """Surfaces are sound and thick enough, have no fluid behind them, and overlap nothing.

    Parameters
    ----------
    boundary
    filling
    dimensions
    fluid : arrays (n, 3) m
        Particles of each region of fluid.
    gauges : pairs
        Names and places [m] of gauges of pressure and velocity.
    """
    _check_options(boundary, dimensions)
    regions, filled = list(fluid), list[tuple[str, Array]]()
    for number, mesh in enumerate(boundary.meshes):
        name = f"boundary.meshes[{number}]"
        try:
            layers = filling.of_moved if mesh in boundary.moved_meshes else filling
            mesh_surface = surface(mesh, layers)
            _check_thickness(name, mesh_surface)
            points, _ = mesh_points(mesh, layers)
        except ValueError as error:
            text = str(error)
            raise ValueError(text if text.startswith(name) else f"{name}: {text}") from error
        for k, places in enumerate(regions):
            _check_fluid(name, f"fluid[{k}]", mesh_surface, places)
        _check_gauges(name, mesh_surface, gauges)
        _check_obstacles(name, points, boundary.solids, filling.spacing)
        for earlier_name, earlier in filled:
            _check_apart(name, points, earlier_name, earlier, filling.spacing)
        filled.append((name, points))


def mesh_surfaces(boundary: Boundary, filling: Filling) -> list[Surface]:
    """Surfaces from files, in the order of the scene."""
    return [surface(mesh, filling) for mesh in boundary.meshes]


def region_points(fluid: Fluid, spacing: float) -> list[Array]:
    """Particles (n, 3) m of each region of fluid in three dimensions, not staggered."""
    return [
        fill_box(region.bounds, cells(region.bounds, spacing, 3))
        if region.shape == "box"
        else fill_shape(region, spacing, False)
        for region in fluid
    ]


def _check_options(boundary: Boundary, dimensions: int) -> None:
    conflict = ""
    if dimensions == 2:
        conflict = "dimensions 2. Set dimensions to 3, or use obstacles"
    elif boundary.method == "potential":
        conflict = "boundary.method potential. Use mdbc or dbc"
    elif boundary.symmetry:
        conflict = f"boundary.symmetry {list(boundary.symmetry)}. Leave one of the two out"
    elif boundary.lubrication_films is True:
        raise ValueError(
            "boundary.lubrication_films is not available with boundary.meshes. Remove one of them."
        )
    if conflict:
        raise ValueError(
            "boundary.meshes are walls in three dimensions, without planes of symmetry or the "
            f"contact potential; found {conflict}."
        )


def _check_thickness(name: str, mesh_surface: Surface) -> None:
    least, place = mesh_surface.thinnest()
    if least < (THIN - 1e-6) * mesh_surface.spacing:
        raise ValueError(
            f"{name} must have {THIN:g} spacings, {THIN * mesh_surface.spacing:g} m, or more of "
            f"solid behind each face, or the surface overlaps itself; found {least:.3g} m behind "
            f"{np.array2string(place, precision=4)} m. Refine the spacing, thicken it, or choose "
            "the other fluid_side."
        )


def _check_fluid(name: str, region: str, mesh_surface: Surface, places: Array) -> None:
    depth, _ = mesh_surface.depths(places)
    rows = np.flatnonzero(depth > -APART * mesh_surface.spacing)
    if len(rows):
        deepest = float(depth.max())
        point = np.array2string(places[np.argmax(depth)], precision=4)
        place = f"{deepest:.3g} m behind" if deepest > 0.0 else f"{-deepest:.3g} m in front"
        place = "far behind" if deepest >= FAR else place
        raise ValueError(
            f"{name} must have all fluid {APART:g} spacings, {APART * mesh_surface.spacing:g} m, "
            f"or more in front of it; found {len(rows)} of {len(places)} particles of {region} "
            f"behind or nearer, one {place}, at {point} m. Cut the fluid, or choose the other "
            "fluid_side."
        )


def _check_gauges(name: str, mesh_surface: Surface, gauges: Sequence[tuple[str, Vector]]) -> None:
    if not gauges:
        return
    depth, _ = mesh_surface.depths(np.array([place for _, place in gauges]))
    rows = np.flatnonzero(depth > 1e-6 * mesh_surface.spacing)
    if len(rows):
        gauge, place = gauges[rows[0]]
        raise ValueError(
            f"gauges.{gauge} must not be behind {name}; found {tuple(place)} m. Move the gauge "
            "into the fluid."
        )


def _check_obstacles(name: str, points: Array, boxes: Sequence[Bounds], spacing: float) -> None:
    tolerance = 1e-6 * spacing
    for number, (low, high) in enumerate(boxes):
        inside = (points > np.array(low) + tolerance) & (points < np.array(high) - tolerance)
        if count := int(inside.all(axis=1).sum()):
            raise ValueError(
                f"{name} must not overlap boundary.obstacles[{number}]; {count} of its "
                f"{len(points)} wall particles stand in it. Move one of the two, or unite both in "
                "one file."
            )


def _check_apart(
    name: str, points: Array, earlier_name: str, earlier: Array, spacing: float
) -> None:
    # Left out of scenes with one surface.
    from scipy.spatial import cKDTree

    distance, _ = cKDTree(earlier).query(points, distance_upper_bound=NEAR * spacing)
    if count := int(np.isfinite(distance).sum()):
        raise ValueError(
            f"{name} must not overlap {earlier_name}; {count} of its {len(points)} wall particles "
            f"stand nearer than {NEAR:g} spacings to others of it. Unite both in one file."
        )


def mesh_notes(boundary: Boundary, filling: Filling) -> tuple[str, ...]:
    """Sizes of surfaces, their particles, and the rims of open ones."""
    notes = []
    for number, mesh in enumerate(boundary.meshes):
        layers = filling.of_moved if mesh in boundary.moved_meshes else filling
        triangles = surface(mesh, layers).triangles
        x, y, z = np.ptp(triangles.corner, axis=(0, 1)).tolist()
        points, _ = mesh_points(mesh, layers)
        text = (
            f"boundary.meshes[{number}], {Path(mesh.path).name}: {len(triangles.corner)} "
            f"triangles, {x:.4g} x {y:.4g} x {z:.4g} m, {len(points)} wall particles"
        )
        if mesh.surface == "open":
            text += f"; its rims have {triangles.rims} edges, and a hole in it would be one"
        notes.append(f"{text}.")
    return tuple(notes)
