"""What a scene says about rigid bodies in contact; checked once, before anything starts."""

from typing import Annotated, ClassVar, Literal, cast

import numpy as np
from pydantic import Field

from quintet.components.dem_bodies.shapes import overlaps
from quintet.components.dem_bodies.shapes.copies import Bodies
from quintet.components.dem_bodies.shapes.description import check_body
from quintet.components.dem_bodies.shapes.planar import check_plane
from quintet.interfaces.params import (
    Count,
    DataFile,
    NotNegative,
    Number,
    Positive,
    PositiveVector,
    Vector,
    parameters,
)

Poisson = Annotated[float, Field(ge=0, le=0.5)]
# Below 0.01 the damping would be stiffer than the contact itself.
Restitution = Annotated[float, Field(ge=0.01, le=1.0)]


@parameters
class Material:
    """An elastic material with its friction and restitution against itself.

    Two materials in contact have the lower of their frictions, restitutions and coefficients of
    rolling friction, unless `pairs` says otherwise.

    Parameters
    ----------
    youngs_modulus : float, Pa, > 0
    poissons_ratio : float, 0 to 0.5
    restitution : float, 0.01 to 1
        Normal velocity after an impact over that before.
    friction : float, ≥ 0
        Coulomb's coefficient.
    rolling_friction : float, ≥ 0, by default 0
        Coefficient of rolling resistance of spheres, the tangent of the slope on which they begin
        to roll; boxes and unions of spheres have none but their shape.
    """

    RENAMED: ClassVar = {
        "young": "youngs_modulus",
        "poisson": "poissons_ratio",
        "rolling": "rolling_friction",
    }
    youngs_modulus: Positive
    poissons_ratio: Poisson
    restitution: Restitution
    friction: NotNegative
    rolling_friction: NotNegative = 0.0


@parameters
class Pair:
    """What holds between two materials, or one and itself, in place of the lower of both.

    Parameters
    ----------
    between : two names of materials
    friction : float, ≥ 0, optional
    restitution : float, 0.01 to 1, optional
    rolling_friction : float, ≥ 0, optional
        At least one of the three.
    """

    RENAMED: ClassVar = {"rolling": "rolling_friction"}
    between: tuple[str, str]
    friction: NotNegative | None = None
    restitution: Restitution | None = None
    rolling_friction: NotNegative | None = None


@parameters
class Copies:
    """A lattice of equal bodies; they count as bodies in its order, x slowest.

    Parameters
    ----------
    number : three int, ≥ 1
        Along x, y and z.
    spacing : three float, m, > 0
        From one copy to the next.
    scatter : float, m, ≥ 0, by default 0
        By which each copy at most is moved along each axis.
    seed : int, by default 0
        Of the scatter.
    """

    number: tuple[Count, Count, Count]
    spacing: PositiveVector
    scatter: NotNegative = 0.0
    seed: int = 0


@parameters
class Agglomerate:
    """The shape in a file, its surface covered by equal spheres on a lattice.

    Parameters
    ----------
    file : str
        STL, OBJ, PLY, or voxels as .npy; named from the scene's folder on.
    scale : float, m, > 0, by default 1
        What one unit of length in the file, or one voxel, stands for.
    dim : int, ≥ 2
        Places of the lattice along the longest edge.
    sphere_radius : float, m, > 0
    """

    file: DataFile
    scale: Positive = 1.0
    dim: Annotated[int, Field(ge=2)]
    sphere_radius: Positive


@parameters
class Body:
    """One rigid body, or a lattice of equal ones.

    Parameters
    ----------
    shape : "box", "sphere", "spheres" or "agglomerate"; in two dimensions "disc" or "polygon"
    size : three float, m, > 0
        Edges of a box.
    edge_radius : float, m, > 0, by default 5 % of the shortest edge
        Radius of a box's edges and corners, or of a polygon's corners; less than half the shortest
        edge of a box.
    diameter : float, m, > 0
        Of a sphere or disc.
    corners : three or more times two float, m
        x and z of a convex polygon's corners, in order round it, in any frame along the body's
        axes: they are moved so that the centre of mass is the origin.
    centres, radii : n times three float, and n float > 0, m
        Of spheres that are one body, in any frame along the body's axes: they are moved so that
        the centre of mass of their union is the origin.
    agglomerate : Agglomerate
        Its centre of mass is the origin too.
    density, mass : float, kg/m3 or kg, > 0
        Exactly one of both; in two dimensions the mass is that of 1 m along y.
    material : str
        One of the materials.
    position : three float, m
        Of the centre of mass.
    orientation : four float w, x, y, z, by default 1, 0, 0, 0
        Unit quaternion, body to world.
    velocity : three float, m/s, by default 0
    angular_velocity : three float, rad/s, by default 0
        In world axes.
    copies : Copies, optional
        A lattice of such bodies, the first at `position`.
    """

    RENAMED: ClassVar = {
        "rounding": "edge_radius",
        "copies": "copies.number",
        "apart": "copies.spacing",
        "scatter": "copies.scatter",
        "seed": "copies.seed",
        "file": "agglomerate.file",
        "scale": "agglomerate.scale",
        "dim": "agglomerate.dim",
        "radius": "agglomerate.sphere_radius",
    }
    shape: Literal["box", "sphere", "spheres", "agglomerate", "disc", "polygon"]
    size: PositiveVector | None = None
    edge_radius: Positive | None = None
    diameter: Positive | None = None
    corners: tuple[tuple[Number, Number], ...] | None = None
    centres: tuple[Vector, ...] | None = None
    radii: tuple[Positive, ...] | None = None
    agglomerate: Agglomerate | None = None
    density: Positive | None = None
    mass: Positive | None = None
    material: str
    position: Vector
    orientation: tuple[Number, Number, Number, Number] = (1.0, 0.0, 0.0, 0.0)
    velocity: Vector = (0.0, 0.0, 0.0)
    angular_velocity: Vector = (0.0, 0.0, 0.0)
    copies: Copies | None = None


@parameters
class Plane:
    """A fixed half-space.

    Parameters
    ----------
    point : three float, m
        Any of its surface.
    normal : three float
        To the free side; of any length.
    material : str
        One of the materials.
    """

    point: Vector
    normal: Vector
    material: str


@parameters
class DemBodiesParams:
    """Rigid bodies, the materials that they are made of, and the planes that hold them.

    Parameters
    ----------
    bodies : list of Body, at least one
    materials : table of Material, by their names
    planes : list of Plane, by default none
    dimensions : 2 or 3, by default 3
        In two all bodies are discs and polygons in the plane of x and z, 1 m deep along y, and move
        in it.
    pairs : list of Pair, by default none
    gravity : three float, m/s2, by default 0, 0, -9.81
    impact_speed : float, m/s, > 0, by default 1
        Of the impacts to be expected; the step resolves them.
    steps_per_contact : int, ≥ 10, by default 40
        In the duration of such an impact.
    longest_step : float, s, > 0, by default 1e-3
        While nothing is about to touch.
    fixed_step : float, s, > 0, optional
        In place of the stable one: to see where that ends.
    contact_forces : bool, by default false
        Whether what contacts do to each body is given, as port `contact`.
    """

    RENAMED: ClassVar = {"speed": "impact_speed", "step": "fixed_step"}
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

    def __post_init__(self) -> None:
        """Refuse what cannot be run, and put every copy among the bodies."""
        for k, body in enumerate(self.bodies):
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
        object.__setattr__(self, "bodies", Bodies(self.bodies))
        check_plane(self)
        check_pairs(self.pairs)
        overlaps.check(self.placed, self.planes)

    @property
    def placed(self) -> Bodies:
        """The same bodies with their copies, as what they are once they are checked."""
        return cast(Bodies, self.bodies)

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
        if pair.friction is None and pair.restitution is None and pair.rolling_friction is None:
            raise ValueError(
                f"pairs[{k}] must say friction, restitution or rolling_friction; found none. "
                "Add one of them, or leave the pair out."
            )
        first = known.setdefault(frozenset(pair.between), k)
        if first != k:
            raise ValueError(
                f"pairs[{k}] must be of other materials than pairs[{first}]; found "
                f"{' and '.join(pair.between)} in both. Join them into one."
            )
