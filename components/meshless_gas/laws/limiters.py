"""Limiters of slopes: the change from a node to the middle of a pair.

Each takes two differences of one variable along a pair: `across` to the other node, `upwind` to its
mirror image, 2∇q·r - Δq. At extremes, where they differ in sign, the change is 0.
"""

from collections.abc import Callable
from typing import NamedTuple

from numba import njit

from quintet.components.shared.numba_options import FAST_LANEWISE

THRESHOLD = 1e-6  # of van Albada's limiter, where the scene says none


class Limiter(NamedTuple):
    """Which limiter a kernel is compiled with, none but that one; without a mark van Albada's.

    Parameters
    ----------
    threshold : float, 1
        Squares of differences below this share of the square of what they are differences of are
        not limited; of van Albada's.
    minmod, van_leer, koren, superbee : True or None
        True of the one that is chosen.
    """

    threshold: float = 0.0
    minmod: bool | None = None
    van_leer: bool | None = None
    koren: bool | None = None
    superbee: bool | None = None


@njit(**FAST_LANEWISE)
def van_albada(upwind, across, threshold):  # type: ignore[no-untyped-def]
    """κ scheme of third order, κ = 1/3, with limiter 2 of van Albada.

    Parameters
    ----------
    upwind, across : float
        Differences to the mirror image of the other node, and to that node.
    threshold : float
        Squares of differences that are small beside it are not limited.

    References
    ----------
    van Albada, van Leer & Roberts, Astron. Astrophys. 108 (1982) 76; κ scheme: van Leer (1985).
    """
    product = 2.0 * upwind * across + threshold
    s = max(product, 0.0) / (upwind * upwind + across * across + threshold)
    return s * ((0.25 - s / 12.0) * upwind + (0.25 + s / 12.0) * across)


@njit(**FAST_LANEWISE)
def minmod(upwind, across, threshold):  # type: ignore[no-untyped-def]
    """Half of the smaller difference.

    References
    ----------
    Roe, Annu. Rev. Fluid Mech. 18 (1986) 337.
    """
    return 0.5 * (max(min(upwind, across), 0.0) + min(max(upwind, across), 0.0))


@njit(**FAST_LANEWISE)
def van_leer(upwind, across, threshold):  # type: ignore[no-untyped-def]
    """Half of the harmonic mean of the differences.

    References
    ----------
    van Leer, J. Comput. Phys. 14 (1974) 361.
    """
    both = upwind + across
    return max(upwind * across, 0.0) * both / max(both * both, 1e-300)


@njit(**FAST_LANEWISE)
def koren(upwind, across, threshold):  # type: ignore[no-untyped-def]
    """κ scheme of third order, κ = 1/3, within the bounds of what lets no total variation grow.

    References
    ----------
    Koren, in Numerical Methods for Advection-Diffusion Problems, Vieweg (1993) 117.
    """
    third = (upwind + 2.0 * across) / 3.0
    least = min(2.0 * min(upwind, across), third)
    most = max(2.0 * max(upwind, across), third)
    return 0.5 * (max(least, 0.0) + min(most, 0.0))


@njit(**FAST_LANEWISE)
def superbee(upwind, across, threshold):  # type: ignore[no-untyped-def]
    """Steepest change that lets no total variation grow: it keeps contacts from spreading.

    References
    ----------
    Roe, Annu. Rev. Fluid Mech. 18 (1986) 337.
    """
    up = max(min(2.0 * upwind, across), min(upwind, 2.0 * across))
    down = min(max(2.0 * upwind, across), max(upwind, 2.0 * across))
    return 0.5 * (max(up, 0.0) + min(down, 0.0))


LAWS: dict[str, Callable[[float, float, float], float]] = {
    "van_albada": van_albada,
    "minmod": minmod,
    "van_leer": van_leer,
    "koren": koren,
    "superbee": superbee,
}


def limiter_of(name: str, threshold: float | None) -> Limiter:
    """Limiter of a name, of van Albada's with its threshold [1]."""
    marks = {} if name == "van_albada" else {name: True}
    return Limiter(THRESHOLD if threshold is None else threshold, **marks)


@njit(**FAST_LANEWISE)
def half_step(limiter, upwind, across, threshold):  # type: ignore[no-untyped-def]
    """Change from a node to the middle of a pair by a limiter."""
    if limiter.minmod is not None:
        return minmod(upwind, across, threshold)
    if limiter.van_leer is not None:
        return van_leer(upwind, across, threshold)
    if limiter.koren is not None:
        return koren(upwind, across, threshold)
    if limiter.superbee is not None:
        return superbee(upwind, across, threshold)
    return van_albada(upwind, across, threshold)
