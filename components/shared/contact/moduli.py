"""Moduli of isotropic elastic materials on which the stiffness of contact depends."""

import numpy as np
from numpy.typing import ArrayLike

from quintet.interfaces.component import Array


def longitudinal_modulus(bulk: ArrayLike, shear: ArrayLike) -> Array:
    """K + 4G/3 [Pa], of strain along one axis."""
    return np.asarray(bulk) + 4.0 / 3.0 * np.asarray(shear)


def plane_modulus(bulk: ArrayLike, shear: ArrayLike) -> Array:
    """E/(1-ν²) = 4G (3K + G)/(3K + 4G) [Pa], of Hertz's contact."""
    k, g = np.asarray(bulk), np.asarray(shear)
    return np.asarray(4.0 * g * (3.0 * k + g) / (3.0 * k + 4.0 * g))


def tangential_modulus(bulk: ArrayLike, shear: ArrayLike) -> Array:
    """G/(2-ν) = 2G (3K + G)/(9K + 6G) [Pa], of Mindlin's contact."""
    k, g = np.asarray(bulk), np.asarray(shear)
    return np.asarray(2.0 * g * (3.0 * k + g) / (9.0 * k + 6.0 * g))
