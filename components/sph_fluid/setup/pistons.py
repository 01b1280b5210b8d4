"""Parts of the boundary that move by themselves: a face of the tank, an obstacle or a mesh."""

import re
from typing import Literal

from quintet.components.sph_fluid.setup.geometry import FACES
from quintet.components.sph_fluid.setup.motion import Motion
from quintet.components.sph_fluid.setup.wave_maker import Waves
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
        How it moves, from where it stands in the scene; this or `waves`.
    waves
        Waves that it makes.
    """

    part: str
    motion: Motion | None = None
    waves: Waves | None = None

    def __post_init__(self) -> None:
        """Refuse names that are none, and parts with two motions."""
        if (self.motion is None) == (self.waves is None):
            motions = "neither" if self.motion is None else "both"
            raise ValueError(f"a piston must have motion or waves; found {motions}. Give one.")
        if PART.fullmatch(self.part) is None:
            raise ValueError(
                f"part must be one of walls.{', walls.'.join(FACES)}, or obstacles.N or meshes.N "
                f"with a number N from 0 on; found {self.part}. Correct it."
            )

    @property
    def path(self) -> Motion | Waves:
        """How it moves."""
        path = self.motion or self.waves
        assert path is not None
        return path

    @property
    def absorbs(self) -> bool:
        """Whether it takes in waves that come back."""
        return self.waves is not None and self.waves.absorption

    @property
    def face(self) -> str:
        """Face of the tank; "" of another part."""
        match = PART.fullmatch(self.part)
        return (match[2] or "") if match else ""

    def number(self, kind: Literal["obstacles", "meshes"]) -> int:
        """Number of the obstacle, or of the mesh; -1 of another part."""
        match = PART.fullmatch(self.part)
        return int(match[4]) if match and match[3] == kind else -1
