"""Checks that a device can compute all that the parameters of bodies ask for."""

from quintet.components.dem_bodies.params import DemBodiesParams, Material, Pair
from quintet.components.dem_bodies.shapes.rigid_body import Plane, RigidBody
from quintet.components.dem_bodies.shapes.solid import is_ball
from quintet.components.shared.opencl.limits import Limit, refuse_wrong
from quintet.interfaces.errors import SceneError

# Every key of the bodies stands here, in `SUPPORTED`, or in the table of `limits`: a test fails
# if a new key is in neither, or if one of the nested tables is not in `SUPPORTED_IN`.
SUPPORTED = frozenset(
    """materials planes pairs gravity impact_speed steps_per_contact longest_step fixed_step
    contact_forces front_gauge""".split()
)
SUPPORTED_IN = {
    Material: frozenset(
        "material youngs_modulus poissons_ratio restitution friction rolling_friction".split()
    ),
    Pair: frozenset("between friction restitution rolling_friction".split()),
    Plane: frozenset("point normal material until".split()),
    # Of kinds; `is_ball` tells those apart that are free spheres.
    RigidBody: frozenset(
        """shape position geometry size edge_radius radius corners centres radii file scale
        agglomerate density mass material orientation velocity angular_velocity locked released_at
        copies""".split()
    ),
}


def refuse_what_needs_the_processor(params: DemBodiesParams, device: str) -> None:
    """Refuse parameters that a device does not compute; see `refuse_wrong`."""
    refuse_wrong(limits(params), device)


def refuse_what_needs_one_rank(params: DemBodiesParams, ranks: int) -> None:
    """Refuse spheres that cannot be shared out among ranks with devices.

    Raises
    ------
    SceneError
        If there is only one.
    """
    if len(params.placed) == 1:
        raise SceneError(
            f"bodies must be two spheres or more on devices of {ranks} ranks; found 1. Set "
            "ranks = 1."
        )


def limits(params: DemBodiesParams) -> dict[str, Limit]:
    """Limits of keys on devices."""
    others = [_described(kind) for kind in params.placed.kinds if not is_ball(kind)]
    shapes, faces = ", ".join(dict.fromkeys(others)), params.contact_with_faces
    return {
        "bodies": Limit(shapes, bool(others), "free spheres", "Leave others out"),
        "dimensions": Limit(params.dimensions, params.dimensions != 3, "3", "Remove it"),
        "contact_with_faces": Limit(str(faces).lower(), faces, "false", "Set it to false"),
    }


def _described(kind: RigidBody) -> str:
    """What kind of body is none of free spheres."""
    return f"{kind.shape} with locked {', '.join(kind.locked)}" if kind.locked else kind.shape
