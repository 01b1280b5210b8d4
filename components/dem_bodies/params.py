"""Parameters of rigid bodies in contact; checked once, before a run starts."""

from typing import Annotated, ClassVar, Literal, cast, get_args

import numpy as np
from pydantic import Field

from quintet.components.dem_bodies.shapes import overlaps
from quintet.components.dem_bodies.shapes.copies import Bodies
from quintet.components.dem_bodies.shapes.description import rigid_body
from quintet.components.dem_bodies.shapes.rigid_body import Agglomerate, Copies, Plane, Quaternion
from quintet.components.dem_bodies.shapes.two_dimensions import check_plane
from quintet.components.shared.geometry.shape_keys import (
    RENAMED,
    BoxKeys,
    MeshKeys,
    PolygonKeys,
    RoundKeys,
)
from quintet.interfaces.materials.filling import MaterialName
from quintet.interfaces.params import (
    NotNegative,
    Positive,
    Vector,
    parameters,
    starts_there,
)

# Directions that may be locked: translation along, rotation about the axes of the world.
Direction = Literal["x", "y", "z", "rotation_x", "rotation_y", "rotation_z"]
DIRECTIONS = get_args(Direction)
Poisson = Annotated[float, Field(ge=0, le=0.5)]
# Below 0.01 the damping would be stiffer than the contact itself.
Restitution = Annotated[float, Field(ge=0.01, le=1.0)]


@parameters
class Material:
    """An elastic material with its friction and restitution against itself.

    Two materials in contact have the lower of their frictions, restitutions and coefficients of
    rolling friction, unless `pairs` sets another.

    Parameters
    ----------
    material
        Name of a material, which gives the constants that are not set here.
    youngs_modulus : Pa
        E.
    poissons_ratio : 1
        ν, transverse contraction over extension.
    restitution : 1
        Normal velocity after an impact over that before.
    friction : 1
        Coulomb's coefficient.
    rolling_friction : 1
        Coefficient of rolling resistance of spheres, the tangent of the slope on which they begin
        to roll. Boxes and unions of spheres resist rolling by their shape alone.
    """

    RENAMED: ClassVar = {
        "young": "youngs_modulus",
        "poisson": "poissons_ratio",
        "rolling": "rolling_friction",
    }
    MATERIAL: ClassVar = {
        key: key
        for key in (
            "youngs_modulus", "poissons_ratio", "restitution", "friction", "rolling_friction"
        )
    }  # fmt: skip
    material: MaterialName | None = None
    youngs_modulus: Positive
    poissons_ratio: Poisson
    restitution: Restitution
    friction: NotNegative
    rolling_friction: NotNegative = 0.0


@parameters
class Pair:
    """Contact properties of two materials, or of one with itself, in place of the lower of both.

    Parameters
    ----------
    between
        Names of the two materials.
    friction : 1
        Coulomb's coefficient; the lower of both if not given.
    restitution : 1
        Normal velocity after an impact over that before; the lower of both if not given.
    rolling_friction : 1
        Coefficient of rolling resistance; the lower of both if not given. A pair sets at least one
        of the three.
    """

    RENAMED: ClassVar = {"rolling": "rolling_friction"}
    between: tuple[str, str]
    friction: NotNegative | None = None
    restitution: Restitution | None = None
    rolling_friction: NotNegative | None = None


@parameters
class Body(BoxKeys, RoundKeys, PolygonKeys, MeshKeys):
    """One rigid body, or a lattice of equal ones.

    Parameters
    ----------
    shape
        Disc and polygon in two dimensions, the others in three.
    edge_radius : m
        Radius of a box's edges and corners, or of a polygon's corners; less than half the shortest
        edge of a box. 5 % of the shortest edge if not given. Contacts of sharp or thin bodies have
        at least the stiffness of a radius of 5 % of the shortest edge, or 0.5 % of the longest.
    centres : m
        Of the spheres that make one body.
    radii : m
        Of the same spheres.
    agglomerate
        How spheres cover the surface of a mesh.
    origin : m
        Where the origin of a polygon's corners, of the centres of spheres or of a mesh's file is,
        before the body is turned; the origin of the world if not given.
    density : kg/m3
        Give the density or the mass.
    mass : kg
        Give the mass or the density; in two dimensions the mass of 1 m along y.
    material
        One of the materials.
    orientation : 1
        Unit quaternion w, x, y, z, by which the shape is turned about its centre of mass.
    velocity : m/s
        Of the centre of mass at the start.
    angular_velocity : rad/s
        At the start, in world axes.
    locked
        Translations along, and rotations about, axes of the world that loads and contacts do not
        change: the body keeps its initial velocity there. An angular velocity about a locked axis
        requires that all three rotations are locked. A body with all six locked is a wall, a plate,
        a piston or a drum. A locked sphere has no rolling resistance.
    released_at : s
        When its locks end, as those of a support; they stay if not given. A sphere has no rolling
        resistance then either.
    copies
        A lattice of such bodies, the first where the shape is.
    """

    RENAMED: ClassVar = {
        **RENAMED,
        "rounding": "edge_radius",
        "copies": "copies.number",
        "apart": "copies.spacing",
        "scatter": "copies.scatter",
        "seed": "copies.seed",
        "dim": "agglomerate.dim",
    }
    shape: Literal["box", "sphere", "spheres", "mesh", "disc", "polygon"]
    edge_radius: Positive | None = None
    centres: tuple[Vector, ...] | None = None
    radii: tuple[Positive, ...] | None = None
    agglomerate: Agglomerate | None = None
    density: Positive | None = None
    mass: Positive | None = None
    material: str
    orientation: Quaternion = (1.0, 0.0, 0.0, 0.0)
    velocity: Vector = (0.0, 0.0, 0.0)
    angular_velocity: Vector = (0.0, 0.0, 0.0)
    locked: tuple[Direction, ...] = ()
    released_at: Positive | None = None
    copies: Copies | None = None


@parameters
class DemBodiesParams:
    """Rigid bodies, the materials that they are made of, and the planes that hold them.

    Parameters
    ----------
    bodies
        Rigid bodies, in the order in which ports count them.
    materials
        Materials of the bodies and planes, by name; each a table, or the name of a material of the
        library or of the scene.
    planes
        Fixed half-spaces that hold them.
    dimensions
        In two dimensions all bodies are discs and polygons in the plane of x and z, 1 m deep along
        y, and move in it.
    pairs
        Contact properties of two materials in place of the lower of both.
    gravity : m/s2
        Acceleration of free fall.
    impact_speed : m/s
        Of the fastest expected impact; the step resolves it.
    steps_per_contact : 1
        Steps in the duration of such an impact.
    longest_step : s
        Limit of the step while nothing is about to touch.
    fixed_step : s
        Step in place of the stable one, to find the limit of stability.
    contact_forces
        Whether the loads of contacts on each body are given, as port `contact`.
    contact_with_faces
        Whether free spheres touch the faces of a partner's mesh (link contact).
    front_gauge
        Axis along which the front of the largest group of touching bodies is given [m].
    """

    RENAMED: ClassVar = {"speed": "impact_speed", "step": "fixed_step", "front": "front_gauge"}
    bodies: Annotated[tuple[Body, ...], Field(min_length=1)]  # once checked, with all copies
    materials: dict[str, Material]
    planes: tuple[Plane, ...] = ()
    dimensions: Literal[2, 3] = 3
    pairs: tuple[Pair, ...] = ()
    gravity: Vector = (0.0, 0.0, -9.81)
    impact_speed: Positive = 1.0
    steps_per_contact: Annotated[int, Field(ge=10)] = 40
    longest_step: Positive = 1e-3
    fixed_step: Positive | None = None
    contact_forces: bool = False
    contact_with_faces: bool = False
    front_gauge: Literal["x", "y", "z"] | None = None

    def __post_init__(self) -> None:
        """Refuse contradictions, and put every copy among the bodies."""
        for k, body in enumerate(self.bodies):
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
        bodies = (rigid_body(f"bodies[{k}]", body) for k, body in enumerate(self.bodies))
        object.__setattr__(self, "bodies", Bodies(bodies))
        check_plane(self.placed, self.planes, self.gravity, self.dimensions)
        check_pairs(self.pairs)
        if self.front_gauge == "y" and self.dimensions == 2:
            raise ValueError(
                "front_gauge must be x or z in two dimensions, where nothing moves along y; found "
                "y. Choose another axis."
            )
        if self.contact_with_faces:
            self._require_spheres()
        if starts_there():
            overlaps.check(self.placed, self.planes)

    def _require_spheres(self) -> None:
        if self.contact_forces:
            raise ValueError(
                "contact_forces must be false with contact_with_faces, as port contact has no "
                "forces of faces; found both true. Leave out contact_forces."
            )
        for kind in self.placed.kinds:
            if self.dimensions == 2 or kind.radius is None or kind.locked:
                raise ValueError(
                    "contact_with_faces needs bodies that are free spheres in three dimensions; "
                    f"found {'two dimensions' if self.dimensions == 2 else 'another body'}. Leave "
                    "it out, or give all bodies shape sphere and nothing locked."
                )

    @property
    def placed(self) -> Bodies:
        """The same bodies with their copies, of the type that they have after the check."""
        return cast(Bodies, self.bodies)

    def _known(self, where: str, name: str) -> None:
        if name not in self.materials:
            raise ValueError(
                f"{where} must be one of the materials {', '.join(self.materials)}; "
                f"found {name!r}. Add it to materials, or correct the name."
            )


def check_pairs(pairs: tuple[Pair, ...]) -> None:
    """Refuse pairs without a property, and repeated pairs."""
    known: dict[frozenset[str], int] = {}
    for k, pair in enumerate(pairs):
        if pair.friction is None and pair.restitution is None and pair.rolling_friction is None:
            raise ValueError(
                f"pairs[{k}] must set friction, restitution or rolling_friction; found none. "
                "Add one of them, or leave the pair out."
            )
        first = known.setdefault(frozenset(pair.between), k)
        if first != k:
            raise ValueError(
                f"pairs[{k}] must be of other materials than pairs[{first}]; found "
                f"{' and '.join(pair.between)} in both. Join them into one."
            )
