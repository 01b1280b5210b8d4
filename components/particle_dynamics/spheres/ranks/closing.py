"""How fast spheres may approach each other, or walls."""

import math

import numpy as np

from quintet.components.particle_dynamics.spheres.kernels import (
    fastest_into_walls,
    furthest_from,
    largest,
    sum_rounded,
)
from quintet.components.particle_dynamics.spheres.ranks.method import Ranks
from quintet.interfaces.component import Array

LARGEST = 1000  # power of two, above which sums are not exact


def mean(ranks: Ranks, vectors: Array) -> Array:
    """Mean (3,) of vectors (n, 3) of all ranks, rounded alike whatever their order."""
    bits = math.ceil(math.log2(ranks.count + 2))
    exponent = bits + math.frexp(ranks.greatest(largest(vectors)))[1]
    unit = math.ldexp(1.0, min(exponent, LARGEST))
    return ranks.added(np.array(sum_rounded(vectors, unit))) / ranks.count


def closing_speed(ranks: Ranks, rates: Array, planes: Array, collide: bool) -> float:
    """Greatest rate at which two spheres, or one and a wall, may approach each other.

    Parameters
    ----------
    ranks : Ranks
    rates : (n, 3) float array
        Velocities m/s, or accelerations m/s2, of this rank's spheres.
    planes : (w, 4) float array, 1 and m
        Unit normals and offsets of walls.
    collide : bool
        Whether spheres strike each other.
    """
    fastest = fastest_into_walls(rates, planes) if len(planes) else 0.0
    if collide:
        fastest = max(fastest, 2.0 * furthest_from(rates, mean(ranks, rates)))
    return ranks.greatest(fastest)
