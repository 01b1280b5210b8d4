"""Checks of a tank that repeats along axes; each mistake is one sentence."""

from quintet.components.sph_fluid.setup.boundary import Boundary
from quintet.components.sph_fluid.setup.geometry import ROUNDING
from quintet.interfaces.params import Vector

LEAST = 5.0 / 3.0  # of three smoothing lengths: two reaches of the neighbour lists


def check_periodic(
    boundary: Boundary, dimensions: int, gravity: Vector, pair_range: float, spacing: float
) -> None:
    """A tank repeats along axes without walls, over lengths that pairs do not reach across.

    Parameters
    ----------
    pair_range : float, m
        Three smoothing lengths.
    """
    for axis in boundary.periodic:
        name, number = f"boundary.periodic: {axis}", "xyz".index(axis)
        if boundary.tank is None:
            raise ValueError(
                f"{name} needs boundary.walls, whose length along {axis} is the period; found "
                "none. Give walls."
            )
        faces = [f for f in (*boundary.open_faces, *boundary.symmetry) if f[0] == axis]
        if faces:
            raise ValueError(
                f"{name} must be an axis whose faces are neither open nor planes of symmetry; "
                f"found {faces}. Take them out of open_faces and symmetry, or remove {axis}."
            )
        if dimensions == 2 and axis == "y":
            raise ValueError(
                f"{name} must be x or z in two dimensions, where nothing changes along y. Remove "
                "it."
            )
        if axis == "z" and gravity[2] != 0.0:
            raise ValueError(
                f"{name} needs gravity without z, for a tank without a bottom bears no weight; "
                f"found {gravity} m/s2. Turn gravity, or remove z."
            )
        length = boundary.tank[1][number] - boundary.tank[0][number]
        if length < LEAST * pair_range:
            raise ValueError(
                f"{name}: the tank must be {LEAST * pair_range:.4g} m or more along {axis}, 5 "
                f"smoothing lengths, or pairs meet twice; found {length:g} m. Lengthen it, or "
                "refine the spacing."
            )
        _check_obstacles(boundary, number, ROUNDING * spacing)
    _check_others(boundary)


def _check_obstacles(boundary: Boundary, axis: int, tolerance: float) -> None:
    assert boundary.tank is not None
    low, high = boundary.tank[0][axis], boundary.tank[1][axis]
    for number, box in enumerate(boundary.solids):
        begins, ends = box[0][axis] - low, high - box[1][axis]  # m, from the faces
        is_between = min(begins, ends) > tolerance
        reaches_through = max(abs(begins), abs(ends)) < tolerance
        if not (is_between or reaches_through):
            raise ValueError(
                f"boundary.obstacles[{number}] must stand between the faces across "
                f"{'xyz'[axis]}, {low:g} to {high:g} m, where the tank repeats, or reach from one "
                f"to the other; found {box}. Move it, or the tank's walls."
            )


def _check_others(boundary: Boundary) -> None:
    """Refuse options that have no images a period away."""
    conflicts = {
        "symmetry": (boundary.symmetry, "make these faces walls"),
        "meshes": (tuple(mesh.file for mesh in boundary.meshes), "use obstacles"),
        "lubrication_films": (boundary.lubrication_films is True, "leave films out"),
    }
    for key, (value, remedy) in conflicts.items():
        if value:
            raise ValueError(
                f"boundary.{key} is not available with boundary.periodic; found {value} and "
                f"{boundary.periodic}. Remove one of them, or {remedy}."
            )
