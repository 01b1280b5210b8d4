"""Fields that spheres state before they are built: their places and sizes."""

from collections.abc import Sequence

import numpy as np

from quintet.components.particle_dynamics.spheres.params import ParticleSpheresParams, Sphere
from quintet.components.shared.geometry.lattice import lattice_points
from quintet.interfaces.component import Array, Fields

MOST = 1_000_000  # spheres; of more, nothing is stated before they are built


def initial(params: ParticleSpheresParams) -> Fields:
    """Places, radii and diameters of spheres, in their order; nothing of very many."""
    count = [sphere.count for sphere in params.spheres]
    if sum(count) > MOST:
        return {}
    radius = np.repeat(np.array([sphere.radius for sphere in params.spheres]), count)
    return {
        "motion.position": places(params.spheres),
        "motion.radius": radius,
        "spheres.diameter": 2.0 * radius,
    }


def places(entries: Sequence[Sphere]) -> Array:
    """Centres (n, 3) m of spheres and of their copies, in the order of the scene."""
    count = [sphere.count for sphere in entries]
    centres = np.repeat(np.array([sphere.centre for sphere in entries], float), count, 0)
    first = 0
    for sphere in entries:
        if sphere.copies is not None:
            axes = [np.arange(number) for number in sphere.copies.number]
            steps = lattice_points(axes, x_fastest=False) * np.array(sphere.copies.spacing)
            centres[first : first + sphere.count] += steps
        first += sphere.count
    return centres
