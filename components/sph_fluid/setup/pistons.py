"""Parts of the boundary that move by themselves: a face of the tank, an obstacle or a mesh."""

import re
from typing import Literal

from quintet.components.sph_fluid.setup.geometry import FACES
from quintet.components.sph_fluid.setup.motion import Motion
from quintet.interfaces.params import parameters

PART = re.compile(r"(?:(walls)\.([xyz][-+]))|(?:(obstacles|meshes)\.(0|[1-9]\d{0,5}))")
Kind = Literal["walls", "obstacles", "meshes"]


@parameters
class Piston:
    """A part of the boundary that moves while the others stand, as a wave maker does.

    Its particles move with it, and push the fluid; the work that they do counts as work from
    outside.

    Parameters
    ----------
    part
        A face of the tank, as "walls.x-", or an obstacle or a mesh by its number, as "obstacles.0".
    motion
        How it moves, from where it stands in the scene.
    """

    part: str
    motion: Motion

    def __post_init__(self) -> None:
        """Refuse names that are none."""
        if PART.fullmatch(self.part) is None:
            raise ValueError(
                f"part must be one of walls.{', walls.'.join(FACES)}, or obstacles.N or meshes.N "
                f"with a number N from 0 on; found {self.part}. Correct it."
            )

    @property
    def face(self) -> str:
        """Face of the tank; "" of another part."""
        match = PART.fullmatch(self.part)
        return (match[2] or "") if match else ""

    def number(self, kind: Literal["obstacles", "meshes"]) -> int:
        """Number of the obstacle, or of the mesh; -1 of another part."""
        match = PART.fullmatch(self.part)
        return int(match[4]) if match and match[3] == kind else -1
