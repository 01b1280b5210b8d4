"""What a scene says about rigid bodies in contact; checked once, before anything starts."""

import math
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from quintet.components.dem_bodies import placement
from quintet.components.dem_bodies.agglomerate import Agglomerate, agglomerate
from quintet.interfaces.component import Port
from quintet.interfaces.params import (
    Count,
    NotNegative,
    Number,
    Positive,
    PositiveVector,
    Vector,
    parameters,
)
from quintet.interfaces.ports import LOAD

Poisson = Annotated[float, Field(ge=0, le=0.5)]
# Below 0.01 the damping would be stiffer than the contact itself.
Restitution = Annotated[float, Field(ge=0.01, le=1.0)]
SIZES = {
    "box": ("size",),
    "sphere": ("diameter",),
    "spheres": ("centres", "radii"),
    "agglomerate": ("file", "dim", "radius"),
}
# What all contacts of a body do to it; the last item is what the planes together bear.
CONTACT = Port("contact", LOAD.fields)


@parameters
class Material:
    """An elastic material with its friction and restitution against itself.

    `rolling` is the coefficient of rolling resistance of spheres, the tangent of the slope on
    which they begin to roll; boxes and clumps have none but their shape.
    Two materials in contact have the lower of their frictions, restitutions and rolling
    coefficients, unless `pairs` says otherwise.
    """

    young: Positive  # Pa
    poisson: Poisson
    restitution: Restitution
    friction: NotNegative
    rolling: NotNegative = 0.0


@parameters
class Pair:
    """What holds between two materials, or one and itself, in place of the lower of both."""

    between: tuple[str, str]
    friction: NotNegative | None = None
    restitution: Restitution | None = None
    rolling: NotNegative | None = None


@parameters
class Body:
    """One rigid body: `size` for a box, `diameter` for a sphere, `centres` and `radii` for spheres.

    The centres may be given in any frame along the body's axes: they are moved so that the
    centre of mass of the union is the origin. An agglomerate is the shape in a `file`, covered by
    spheres of one `radius` on a lattice with `dim` places along its longest edge; its centre of
    mass is the origin too. Give either `density` or `mass`.

    `copies` sets a lattice of such bodies: the first at `position`, others `apart` from it. They
    count as bodies in the lattice's order, x slowest; `scatter` breaks its regularity.
    """

    shape: Literal["box", "sphere", "spheres", "agglomerate"]
    size: PositiveVector | None = None  # m, edges
    diameter: Positive | None = None  # m
    centres: tuple[Vector, ...] | None = None  # m
    radii: tuple[Positive, ...] | None = None  # m
    file: str | None = None  # STL, OBJ, PLY, or voxels as .npy; beside the scene
    scale: Positive = 1.0  # m, that one unit of length in the file, or one voxel, stands for
    dim: Annotated[int, Field(ge=2)] | None = None
    radius: Positive | None = None  # m
    rounding: Positive | None = None  # m, radius of a box's edges; 5 % of the smallest edge
    density: Positive | None = None  # kg/m3
    mass: Positive | None = None  # kg
    material: str
    position: Vector  # m, of the centre of mass
    orientation: tuple[Number, Number, Number, Number] = (1.0, 0.0, 0.0, 0.0)  # w, x, y, z
    velocity: Vector = (0.0, 0.0, 0.0)  # m/s
    angular_velocity: Vector = (0.0, 0.0, 0.0)  # rad/s, world axes
    copies: tuple[Count, Count, Count] | None = None  # along x, y, z; x changes slowest
    apart: PositiveVector | None = None  # m, from one copy to the next
    scatter: NotNegative = 0.0  # m, by which each copy at most is moved along each axis
    seed: int = 0  # of the scatter

    @property
    def round(self) -> float:
        """Radius of a box's edges [m]."""
        assert self.size is not None
        return 0.05 * min(self.size) if self.rounding is None else self.rounding

    @property
    def agglomerate(self) -> Agglomerate | None:
        """What the file, dim and radius make, of a body that is an agglomerate."""
        if self.file is None:
            return None
        assert self.dim is not None and self.radius is not None
        return agglomerate(self.file, self.scale, self.dim, self.radius)


@parameters
class Plane:
    """A fixed half-space; its normal points to the free side."""

    point: Vector  # m
    normal: Vector
    material: str


@parameters
class DemBodiesParams:
    """Rigid bodies, the materials that they are made of, and the planes that hold them."""

    bodies: Annotated[tuple[Body, ...], Field(min_length=1)]
    materials: dict[str, Material]
    planes: tuple[Plane, ...] = ()
    pairs: tuple[Pair, ...] = ()
    gravity: Vector = (0.0, 0.0, -9.81)  # m/s2
    speed: Positive = 1.0  # m/s, of the impacts to be expected
    steps_per_contact: Annotated[int, Field(ge=10)] = 40  # in the duration of such an impact
    longest_step: Positive = 1e-3  # s, while nothing is about to touch
    step: Positive | None = None  # s, in place of the stable one: to see where that ends
    contact_forces: bool = False  # whether they are given, as port `contact`

    def __post_init__(self) -> None:
        """Refuse what cannot be run, and put every copy among the bodies."""
        for k, body in enumerate(self.bodies):
            check_copies(f"bodies[{k}]", body)
            check_body(f"bodies[{k}]", body)
            self._known(f"bodies[{k}].material", body.material)
        for k, plane in enumerate(self.planes):
            if not np.linalg.norm(plane.normal) > 0.0:
                raise ValueError(
                    f"planes[{k}].normal must have a direction; found {plane.normal}. "
                    "Let it point to the free side."
                )
            self._known(f"planes[{k}].material", plane.material)
        for k, pair in enumerate(self.pairs):
            for name in pair.between:
                self._known(f"pairs[{k}].between", name)
        object.__setattr__(self, "bodies", placement.copied(self.bodies))
        check_pairs(self.pairs)
        placement.check(self.bodies, self.planes)

    def _known(self, where: str, name: str) -> None:
        if name not in self.materials:
            raise ValueError(
                f"{where} must be one of the materials {', '.join(self.materials)}; "
                f"found {name!r}. Add it to materials, or correct the name."
            )


def check_pairs(pairs: tuple[Pair, ...]) -> None:
    """Refuse pairs that say nothing, or that are said twice."""
    known: dict[frozenset[str], int] = {}
    for k, pair in enumerate(pairs):
        if pair.friction is None and pair.restitution is None and pair.rolling is None:
            raise ValueError(
                f"pairs[{k}] must say friction, restitution or rolling; found none. "
                "Add one of them, or leave the pair out."
            )
        first = known.setdefault(frozenset(pair.between), k)
        if first != k:
            raise ValueError(
                f"pairs[{k}] must be of other materials than pairs[{first}]; found "
                f"{' and '.join(pair.between)} in both. Join them into one."
            )


def check_body(where: str, body: Body) -> None:
    """Refuse a body whose description is incomplete or contradicts itself."""
    wanted = SIZES[body.shape]
    known = {name for names in SIZES.values() for name in names}
    found = sorted(name for name in known if getattr(body, name) is not None)
    if found != sorted(wanted):
        raise ValueError(
            f"{where}: a {body.shape} is described by {' and '.join(wanted)} alone; "
            f"found {', '.join(found) or 'none'}. Give {' and '.join(wanted)}."
        )
    if (body.density is None) == (body.mass is None):
        raise ValueError(
            f"{where}: exactly one of density and mass must be given; found density "
            f"{body.density}, mass {body.mass}. Leave one out."
        )
    length = math.hypot(*body.orientation)
    if abs(length - 1.0) > 1e-6:
        raise ValueError(
            f"{where}.orientation must be a unit quaternion (w, x, y, z); found "
            f"{body.orientation} of length {length:.6g}. Divide it by its length."
        )
    if body.rounding is not None and body.shape != "box":
        raise ValueError(
            f"{where}.rounding is for boxes; found it on a {body.shape}. Leave it out."
        )
    if body.scale != 1.0 and body.file is None:
        raise ValueError(
            f"{where}.scale is for what is read from a file; found it on a {body.shape}. "
            "Leave it out."
        )
    try:
        body.agglomerate  # noqa: B018  (the mistakes that are in the file)
    except ValueError as error:
        raise ValueError(f"{where}: {error}") from error
    if body.size is not None and not body.round < 0.5 * min(body.size):
        raise ValueError(
            f"{where}.rounding must be less than half the smallest edge, "
            f"{0.5 * min(body.size):.6g} m; found {body.round:.6g} m. Make it smaller."
        )
    if body.centres is not None and body.radii is not None:
        if len(body.centres) != len(body.radii) or not body.radii:
            raise ValueError(
                f"{where}: spheres need one radius for each centre, and at least one; found "
                f"{len(body.centres)} centres and {len(body.radii)} radii. Complete them."
            )


def check_copies(where: str, body: Body) -> None:
    """Refuse copies that have no place of their own."""
    if (body.copies is None) != (body.apart is None):
        raise ValueError(
            f"{where}: copies and apart belong together; found copies {body.copies}, apart "
            f"{body.apart}. Give both or none."
        )
    if body.copies is None and body.scatter > 0.0:
        raise ValueError(
            f"{where}.scatter is for copies; found {body.scatter:g} m on a single body. "
            "Leave it out, or give copies."
        )
