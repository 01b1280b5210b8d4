"""Limiters of slopes: the change from a node to the middle of a pair.

Each takes two differences of one variable along a pair: `across` to the other node, `upwind` to its
mirror image, 2∇q·r - Δq. At extremes, where they differ in sign, the change is 0.
"""

from collections.abc import Callable
from typing import NamedTuple

from numba import njit
from numba.extending import overload

from quintet.components.shared.numba_options import FAST_LANEWISE

THRESHOLD = 1e-6  # of van Albada's limiter, where the scene says none


class Limiter(NamedTuple):
    """Which limiter a kernel is compiled with: by the class that it is given, none but that one.

    Parameters
    ----------
    threshold : float, 1
        Squares of differences below this share of the square of what they are differences of are
        not limited; of van Albada's.
    """

    threshold: float = 0.0


class VanAlbada(Limiter):
    """See `van_albada`."""


class Minmod(Limiter):
    """See `minmod`."""


class VanLeer(Limiter):
    """See `van_leer`."""


class Koren(Limiter):
    """See `koren`."""


class Superbee(Limiter):
    """See `superbee`."""


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


LAWS: dict[type[Limiter], Callable[[float, float, float], float]] = {
    VanAlbada: van_albada,
    Minmod: minmod,
    VanLeer: van_leer,
    Koren: koren,
    Superbee: superbee,
}
NAMED: dict[str, type[Limiter]] = {
    "van_albada": VanAlbada,
    "minmod": Minmod,
    "van_leer": VanLeer,
    "koren": Koren,
    "superbee": Superbee,
}


def limiter_of(name: str, threshold: float | None) -> Limiter:
    """Limiter of a name, of van Albada's with its threshold [1]."""
    return NAMED[name](THRESHOLD if threshold is None else threshold)


def half_step(limiter: Limiter, upwind: float, across: float, threshold: float) -> float:
    """Change from a node to the middle of a pair by a limiter."""
    raise NotImplementedError("it is called by compiled functions only")


@overload(half_step, jit_options=FAST_LANEWISE)
def _half_step(limiter, upwind, across, threshold):  # type: ignore[no-untyped-def]
    law = LAWS[limiter.instance_class]

    def limited(limiter, upwind, across, threshold):  # type: ignore[no-untyped-def]
        return law(upwind, across, threshold)

    return limited
