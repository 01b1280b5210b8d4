"""What the motion of a tank must suit; each mistake is one sentence."""

from quintet.components.sph_fluid.setup.boundary import Boundary
from quintet.components.sph_fluid.setup.motion import Motion
from quintet.components.sph_fluid.setup.wave_maker import Waves

ACROSS = 1e-12  # of a unit vector: how far an axis may lean from an axis of coordinates


def check_motion(boundary: Boundary, motion: Motion, dimensions: int) -> None:
    """There is something that moves, in the plane of a fluid of two dimensions and of symmetry."""
    if boundary.tank is None and not boundary.solids and not boundary.meshes:
        raise ValueError(
            "boundary.motion needs walls, obstacles or meshes that move; found none. Add them, or "
            "remove motion."
        )
    if dimensions == 2 and not is_along(motion, "y"):
        raise ValueError(
            "boundary.motion must stay in the plane of x and z in two dimensions: displaced by "
            f"nothing along y, and turned about y; found displacements along "
            f"{_named(motion) or 'no axis'} and the axis {motion.axis}. Correct it, or set "
            "dimensions to 3."
        )
    for face in boundary.symmetry:
        if not is_along(motion, face[0]):
            raise ValueError(
                f"boundary.motion must stay in the plane of boundary.symmetry {face}: displaced by "
                f"nothing along {face[0]}, and turned about {face[0]}; found displacements along "
                f"{_named(motion) or 'no axis'} and the axis {motion.axis}. Correct it, or make "
                "the face a wall."
            )


def is_along(motion: Motion | Waves, name: str) -> bool:
    """Whether nothing is displaced along an axis, and all is turned about it."""
    axis = "xyz".index(name)
    leaning = [abs(part) for k, part in enumerate(motion.direction) if k != axis]
    return not motion.shifts[axis] and not (motion.turns and max(leaning) > ACROSS)


def _named(motion: Motion) -> str:
    return ", ".join(name for name, shifts in zip("xyz", motion.shifts, strict=True) if shifts)
