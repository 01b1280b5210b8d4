"""What a scene says about elastic-plastic bodies of particles."""

import math
from typing import Annotated, Literal

from pydantic import Field

from quintet.components.shared.geometry.selections import ByBox
from quintet.components.shared.geometry.shapes import Cylinder
from quintet.components.sph_solid.body import Axis, Body
from quintet.interfaces.params import (
    Fraction,
    NotNegative,
    Number,
    Positive,
    Vector,
    parameters,
)

LEAST_SMOOTHING, MOST_SMOOTHING = 0.9, 4.0
NARROW = 2.4  # smoothing lengths between planes: nothing is as near to the images of images


@parameters
class SymmetryPlane:
    """A plane of symmetry across an axis.

    Parameters
    ----------
    axis
        Across which it stands.
    position : m
        Along that axis.
    side
        The side that is computed: "+" beyond the position, "-" before it.
    """

    axis: Axis
    position: Number = 0.0
    side: Literal["+", "-"] = "+"


@parameters
class Region(ByBox):
    """Particles that are in a box at the start."""


@parameters
class Fixed(ByBox):
    """Particles that are held: those that are in a box at the start.

    Parameters
    ----------
    directions
        Along which they keep their places; all for clamped ones.
    """

    directions: tuple[Axis, ...] = ("x", "y", "z")


@parameters
class Level:
    """A line along z through a body, on which the ends of what has not failed are read.

    Parameters
    ----------
    place : m
        Where it stands, x and y.
    body : 1
        Number of the body, from 0.
    """

    place: tuple[Number, Number] = (0.0, 0.0)
    body: Annotated[int, Field(ge=0)]


@parameters
class SphSolidParams:
    """Bodies of particles, and how they are computed.

    Parameters
    ----------
    spacing : m
        Of the particles at the start.
    bodies
        They touch where their particles come near.
    dimensions
        In 2 the bodies lie in the plane of x and z, are 1 m deep, and do not strain along y.
    axisymmetric
        With 2 dimensions: bodies are those of the half-plane x > 0, turned about the axis z.
    smoothing : 1
        Smoothing length of the cubic spline over the spacing.
    symmetry
        Planes of symmetry; two that face each other enclose a strip.
    fixed
        Particles that are held.
    glued
        Particles that hang on a partner's mesh: they move with it, and it bears their mass.
    contact_with_faces
        Whether particles touch the faces of a partner's mesh, at half a spacing (link contact).
    gravity : m/s2
        Of particles that are not glued; the mesh bears the weight of those that are.
    gauges : m
        Places; of the particle that is nearest to each at the start, motion and stress are given.
    levels
        Lines along z: how high and how low a body is there, as of a crater.
    courant : 1
        Share of h/(c + 1.2 (α c + β max|μ|)) that a step takes.
    viscosity_linear, viscosity_quadratic : 1
        α and β of Monaghan's artificial viscosity. If not given: 1 and 2; 0.1 and 0.5 of
        materials without equation of state and failure that meet below a tenth of the speed of
        sound; 0 of elastic bodies with the neighbours of the start.
    kernel_correction
        Whether gradients are corrected to be exact for linear fields; not at failed particles nor
        their neighbours. If not given: as with viscosities of 0.1 and 0.5.
    artificial_stress : 1
        ε of the pressure, as a share of tension, by which near particles repel each other where
        the material is stretched, so that they form no clumps; 0.3 is usual, 0 has none.
    total_lagrangian
        Whether pairs are those of the start for good, and gradients those with respect to places
        there (Ganzenmüller): stretched bodies form no clumps and cannot tear. Particles that were
        no neighbours at the start push each other off at a spacing, without friction or
        viscosity. Bodies that are neighbours at the start are one if their velocities are the
        same. Fragments hold together by what they bear in compression. If not given: where all
        materials are elastic and neither kernel_correction, artificial_stress nor axisymmetric
        is.
    """

    spacing: Positive
    bodies: tuple[Body, ...]
    dimensions: Literal[2, 3] = 3
    axisymmetric: bool = False
    smoothing: Positive = 1.2
    symmetry: tuple[SymmetryPlane, ...] = ()
    fixed: tuple[Fixed, ...] = ()
    glued: tuple[Region, ...] = ()
    contact_with_faces: bool = False
    gravity: Vector = (0.0, 0.0, 0.0)
    gauges: tuple[Vector, ...] = ()
    levels: tuple[Level, ...] = ()
    courant: Positive = 0.5
    viscosity_linear: NotNegative | None = None
    viscosity_quadratic: NotNegative | None = None
    kernel_correction: bool | None = None
    artificial_stress: Fraction = 0.0
    total_lagrangian: bool | None = None

    def __post_init__(self) -> None:
        _require(self.bodies, "bodies must be at least one; found none. Add [[bodies]].")
        _require(
            LEAST_SMOOTHING <= self.smoothing <= MOST_SMOOTHING,
            f"smoothing must lie between {LEAST_SMOOTHING:g} and {MOST_SMOOTHING:g}: with "
            "less, gradients of a lattice are wrong by more than 5 %, with more each particle "
            f"has thousands of neighbours; found {self.smoothing:g}. 1.2 is usual.",
        )
        _require(
            all(level.body < len(self.bodies) for level in self.levels),
            f"levels: body must be below {len(self.bodies)}, the number of bodies; found "
            f"{', '.join(str(level.body) for level in self.levels)}. Correct it.",
        )
        self._check_symmetry()
        self._check_method()
        _require(
            not (self.contact_with_faces and (self.glued or self.axisymmetric)),
            "contact_with_faces needs bodies that are neither glued nor axisymmetric; found "
            f"{'glued particles' if self.glued else 'axisymmetric'}. Leave out one of the two.",
        )
        if self.dimensions == 2:
            self._check_plane()
        if self.axisymmetric:
            self._check_axisymmetric()

    def _check_symmetry(self) -> None:
        sides = [plane.axis + plane.side for plane in self.symmetry]
        _require(
            len(set(sides)) == len(sides),
            f"symmetry: a side must have one plane at most; found {', '.join(sides)}.",
        )
        _require(
            self._narrowest >= NARROW * self.length,
            f"symmetry: two planes must be {NARROW} smoothing lengths apart, "
            f"{NARROW * self.length:g} m; found {self._narrowest:g} m.",
        )

    def _check_method(self) -> None:
        others = self.kernel_correction or self.axisymmetric
        _require(
            not (self.total_lagrangian and (others or self.artificial_stress > 0.0)),
            "total_lagrangian has corrected gradients, needs no artificial stress, and cannot be "
            "axisymmetric: leave out kernel_correction, artificial_stress and axisymmetric.",
        )
        _require(
            not (self.artificial_stress > 0.0 and others),
            "artificial_stress works with uncorrected gradients, and not in axisymmetric bodies: "
            "leave it out, or leave out kernel_correction and axisymmetric.",
        )

    def _check_plane(self) -> None:
        _require(
            all(plane.axis != "y" for plane in self.symmetry),
            "symmetry: in two dimensions no plane can stand across y. Leave it out.",
        )
        _require(
            self.axisymmetric or all(map(_is_planar, self.bodies)),
            "bodies: in two dimensions they must be boxes, or cylinders along y; "
            "axisymmetric ones boxes or spheres.",
        )
        _require(
            not any(map(self._leaves_the_plane, self.bodies)),
            "bodies: in two dimensions angular_velocity is about y alone, and 0 of "
            "axisymmetric ones; velocity and velocity_gradient have nothing along y. Correct it.",
        )
        _require(
            self.gravity[1] == 0.0 and not (self.axisymmetric and self.gravity[0] != 0.0),
            "gravity must lie in the plane of two dimensions, and along z of axisymmetric "
            f"bodies; found {self.gravity} m/s2. Correct it.",
        )

    def _check_axisymmetric(self) -> None:
        across_x = any(plane.axis == "x" for plane in self.symmetry)
        _require(
            self.dimensions == 2 and not across_x and not self.glued,
            "axisymmetric bodies need dimensions = 2, have no symmetry across x, and are not "
            "glued.",
        )
        _require(
            all(map(_is_of_rings, self.bodies)),
            "bodies: axisymmetric ones must be boxes, or spheres with their centre on the axis z.",
        )

    def _leaves_the_plane(self, body: Body) -> bool:
        turn, (along_x, along_y, along_z) = body.angular_velocity, body.velocity_gradient
        turns = turn[0] != 0.0 or turn[2] != 0.0 or (self.axisymmetric and turn[1] != 0.0)
        return turns or any((body.velocity[1], along_x[1], *along_y, along_z[1]))

    @property
    def _narrowest(self) -> float:
        """Least distance [m] between two planes that face each other."""
        narrowest = math.inf
        for axis in "xyz":
            ends = {plane.side: plane.position for plane in self.symmetry if plane.axis == axis}
            if len(ends) == 2:
                narrowest = min(narrowest, ends["-"] - ends["+"])
        return narrowest

    @property
    def length(self) -> float:
        """Smoothing length h [m]."""
        return self.smoothing * self.spacing


def _require(rule: object, sentence: str) -> None:
    if not rule:
        raise ValueError(sentence)


def _is_planar(body: Body) -> bool:
    """Whether a body is the same along y: a box, or a cylinder along it."""
    if body.shape in ("sphere", "mesh"):
        return False
    return not isinstance(body.geometry, Cylinder) or body.geometry.axis == 1


def _is_of_rings(body: Body) -> bool:
    """Whether a body is one of rings about the axis z."""
    if body.shape == "sphere" and body.centre is not None:
        return not any(body.centre[:2])
    return body.shape not in ("cylinder", "mesh")
