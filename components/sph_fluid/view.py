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
    """Corners (k, 3) m of all closed faces of tank, obstacles and meshes, but those of pistons."""
    boundary = params.boundary
    moving_faces = {piston.face for piston in boundary.pistons}
    closed = [face for face in params.closed_faces if face not in moving_faces]
    faces = box(*boundary.tank, closed) if boundary.tank else []
    sides = [face for face in FACES if params.dimensions == 3 or face[0] != "y"]
    standing = [bounds for bounds in boundary.solids if bounds not in boundary.moved_solids]
    faces += [face for bounds in standing for face in box(*bounds, sides)]
    return faces + _faces_of_meshes(params)


def _faces_of_meshes(params: SphFluidParams) -> list[Array]:
    """Triangles (3, 3) m of the surfaces from files that stand."""
    moving_meshes = params.boundary.moved_meshes
    standing = [mesh for mesh in params.boundary.meshes if mesh not in moving_meshes]
    if not standing:
        return []
    # Left out of scenes without boundaries from files.
    from quintet.components.sph_fluid.setup.mesh_surfaces import placed

    return [triangle for mesh in standing for triangle in placed(mesh).corner]
