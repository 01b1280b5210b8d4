"""What a picture shows: particles of the fluid, the tank's walls and the obstacles in it."""

import numpy as np

from quintet.components.shared.geometry.box_faces import box
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.setup.geometry import FACES
from quintet.components.sph_fluid.state import Array, State
from quintet.interfaces.component import Fields


def view(state: State) -> Fields:
    """Copy fluid particles in the order of their birth."""
    rows = np.argsort(state.identity)
    position, velocity = state.position_density[rows], state.velocity_pressure[rows]
    return {
        "points": position[:, :3],
        "velocity": velocity[:, :3].astype(np.float32),
        "density": position[:, 3].astype(np.float32),
        "pressure": (velocity[:, 3] * position[:, 3] ** 2).astype(np.float32),
    }


def wall_faces(params: SphFluidParams) -> list[Array]:
    """Corners (4, 3) m of each closed face of the tank, and of each face of the obstacles."""
    boundary = params.boundary
    faces = box(*boundary.tank, params.closed_faces) if boundary.tank else []
    sides = [face for face in FACES if params.dimensions == 3 or face[0] != "y"]
    return faces + [face for bounds in boundary.solids for face in box(*bounds, sides)]
