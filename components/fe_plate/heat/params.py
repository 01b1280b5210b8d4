"""What a scene says about a body that conducts heat."""

from pathlib import Path
from typing import Annotated, ClassVar

from pydantic import Field

from quintet.components.fe_plate.meshes.files import FileMesh
from quintet.components.fe_plate.meshes.params import MeshedPart
from quintet.components.fe_plate.meshes.selections import Faces, NodeSet
from quintet.components.shared.geometry.selections import ByBoxOrSet
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import (
    NotNegative,
    Number,
    Positive,
    Vector,
    parameters,
)

Tolerance = Annotated[float, Field(gt=0.0, le=1e-3)]


@parameters
class ConductingPart(MeshedPart):
    """A box of equal elements, a cylinder of them, or a mesh of hexahedra from a file.

    Parameters
    ----------
    conductivity : W/(m K)
        k.
    density : kg/m3
        ρ; needed unless only steady temperatures are sought.
    specific_heat : J/(kg K)
        c; needed likewise.
    temperature : K
        At the start.
    """

    conductivity: Positive
    density: Positive | None = None
    specific_heat: Positive | None = None
    temperature: NotNegative = 298.0

    def __post_init__(self) -> None:
        MeshedPart.__post_init__(self)
        if self.tetrahedra:
            raise ValueError(
                "part: heat is conducted through hexahedra alone; found tetrahedra = true. Leave "
                "it out."
            )

    def placed(self) -> FileMesh:
        """Nodes where they are [m], and hexahedra; tetrahedra are refused."""
        if self.has_tetrahedra:
            raise SceneError(
                f"file {Path(self.file or '').name} must have 8-node solids, for heat is conducted "
                "through no others; found tetrahedra. Mesh it with 8-node solids."
            )
        return MeshedPart.placed(self)

    @property
    def capacity(self) -> float:
        """Of a cubic metre [J/(m3 K)]; 0 if it is left out."""
        return (self.density or 0.0) * (self.specific_heat or 0.0)


@parameters
class FixedTemperature(ByBoxOrSet):
    """Nodes that are held at a temperature, whatever heat that takes.

    Parameters
    ----------
    point : m
        In place of a box and a set: the node nearest to here.
    temperature : K
        At which they are held.
    """

    point: Vector | None = None
    temperature: NotNegative

    def __post_init__(self) -> None:
        box = sum(corner is not None for corner in (self.lowest, self.highest))
        ways = (self.point is not None, box > 0, bool(self.node_set))
        if sum(ways) != 1 or box == 1:
            names = ("point", "lowest", "highest", "node_set")
            keys = " and ".join(name for name in names if getattr(self, name))
            raise ValueError(
                "fixed_temperatures: nodes must be chosen by point, by lowest and highest of a "
                f"box, or by node_set; found {keys or 'none of these'}. Give one of the three."
            )


@parameters
class Flux:
    """Heat that enters through outer faces.

    Parameters
    ----------
    faces
        Through which it enters.
    flux : W/m2
        Of each square metre; negative cools.
    """

    faces: Faces
    flux: Number


@parameters
class FeHeatParams:
    """A body that conducts heat, its fixed temperatures and its heat fluxes.

    Parameters
    ----------
    parts
        What it is made of; parts do not touch each other.
    node_sets
        Nodes by name.
    fixed_temperatures
        Nodes at given temperatures; of nodes that are named twice the last entry counts.
    fluxes
        Heat through outer faces; all others are insulated.
    coupled_faces
        Outer faces that partners see; all if none are said.
    node_gauges : m
        Points: the temperature [K] of the node that is nearest to each is given.
    steady
        Whether each step finds the temperatures that would be reached in the end.
    longest_step : s
        Without it a step is as long as is asked for: all are stable.
    tolerance : 1
        Of the linear systems: residual over right side.
    """

    RENAMED: ClassVar = {"held": "fixed_temperatures"}

    parts: tuple[ConductingPart, ...]
    node_sets: tuple[NodeSet, ...] = ()
    fixed_temperatures: tuple[FixedTemperature, ...] = ()
    fluxes: tuple[Flux, ...] = ()
    coupled_faces: tuple[Faces, ...] = ()
    node_gauges: tuple[Vector, ...] = ()
    steady: bool = False
    longest_step: Positive | None = None
    tolerance: Tolerance = 1e-10

    def __post_init__(self) -> None:
        if not self.parts:
            raise ValueError("parts must be at least one; found none. Add [[parts]].")
        for number, part in enumerate(self.parts):
            if not self.steady and part.capacity == 0.0:
                raise ValueError(
                    f"parts.{number}: without steady, a part must have density and specific_heat. "
                    "Give both, or steady = true."
                )
        if self.steady and self.longest_step is not None:
            raise ValueError("longest_step has no meaning with steady = true. Remove one.")
