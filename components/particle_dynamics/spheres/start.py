"""Fields that spheres state before they are built: their diameters."""

import numpy as np

from quintet.components.particle_dynamics.spheres.params import ParticleSpheresParams
from quintet.interfaces.component import Fields

MOST = 1_000_000  # spheres; of more, nothing is stated before they are built


def initial(params: ParticleSpheresParams) -> Fields:
    """Diameters (n,) m of spheres, in their order; nothing of very many."""
    count = [sphere.count for sphere in params.spheres]
    if sum(count) > MOST:
        return {}
    diameter = np.array([2.0 * sphere.radius for sphere in params.spheres])
    return {"spheres.diameter": np.repeat(diameter, count)}
