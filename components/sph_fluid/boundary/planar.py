"""Surface samples of a fluid in two dimensions: all in its plane of x and z, for 1 m along y.

The fluid's particles have kg/m and push with N/m; a slab of 1 m turns these into kg and N, so that
what its totals count is what the samples feel.
"""

from dataclasses import replace

import numpy as np

from quintet.components.sph_fluid.params import SphFluidParams
from quintet.interfaces.component import Array, Fields, Port
from quintet.interfaces.errors import SceneError
from quintet.interfaces.ports import DIMENSIONS

NEARLY = 1e-9  # m


def planar_surface(port: Port) -> Port:
    """Port of surfaces that says that the fluid has two dimensions."""
    return replace(port, requests=(*port.requests, DIMENSIONS))


def require_one_metre(params: SphFluidParams) -> None:
    """Refuse samples, which stand for 1 m along y, in a slab of another thickness."""
    thickness = params.slab_thickness
    if abs(thickness - 1.0) > NEARLY:
        raise SceneError(
            "surface: in two dimensions samples stand for 1 m along y, and so must the fluid; its "
            f"boxes reach over {thickness:g} m. Let them, and the walls, reach over 1 m."
        )


def in_plane(fields: Fields, params: SphFluidParams) -> dict[str, Array]:
    """Positions and velocities (n, 3) of samples in the fluid's own plane, wherever theirs is."""
    (_, low, _), (_, high, _) = params.extents[0]
    planar = {key: np.array(array) for key, array in fields.items()}
    for key, array in planar.items():
        array[:, 1] = 0.0 if key == "surface.velocity" else low + 0.5 * (high - low)
    return planar
