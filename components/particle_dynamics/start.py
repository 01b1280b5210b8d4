"""What spheres state before they are built: how large they are."""

import numpy as np

from quintet.components.particle_dynamics.params import ParticleDynamicsParams
from quintet.interfaces.component import Fields

MOST = 1_000_000  # spheres; of more, nothing is told before they are built


def initial(params: ParticleDynamicsParams) -> Fields:
    """Diameters (n,) m of spheres, in their order; nothing of a lattice or of very many."""
    count = [one.count for one in params.spheres]
    if not 0 < sum(count) <= MOST:
        return {}
    diameter = np.array([2.0 * one.radius for one in params.spheres])
    return {"spheres.diameter": np.repeat(diameter, count)}
