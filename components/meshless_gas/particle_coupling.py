"""What a scene says about particles that the nodes do not resolve."""

from typing import Annotated, Literal

from pydantic import Field

from quintet.interfaces.params import parameters


@parameters
class PointParticles:
    """Spheres of a partner that are smaller than the spacing of the nodes.

    Parameters
    ----------
    drag
        Correlation: of Stokes, of Clift and Gauvin (incompressible), of Henderson (to M = 6), of
        Loth and others (2021, hypersonic).
    heat
        Correlation of the Nusselt number: 2 (still), of Ranz and Marshall (incompressible), of Fox
        and others (compressible).
    nodes : 1
        Nearest nodes among which a particle's gas is averaged and its reaction is shared out; the
        furthest has no weight. By default 16 in two dimensions and 32 in three.
    reaction
        Whether the gas feels the particles.
    """

    drag: Literal["stokes", "clift_gauvin", "henderson", "loth"] = "loth"
    heat: Literal["still", "ranz_marshall", "fox"] = "ranz_marshall"
    nodes: Annotated[int, Field(ge=3)] | None = None
    reaction: bool = True
