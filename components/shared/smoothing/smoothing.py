"""A smoothing kernel of one length h: W and its gradient, whichever kernel was chosen.

All kernels here reach as far as 2h. Laws of pairs take a `Smoothing` and know no other parameters
of a solver; where h differs from particle to particle, `with_length` gives the one of each pair.
"""

import math
from typing import Literal, NamedTuple

from numba import njit

from quintet.components.shared.smoothing import cubic_spline, quintic_spline, wendland
from quintet.components.shared.smoothing.cubic_spline import SUPPORT

TINY = 1e-12  # h²
KERNELS = ("cubic", "quintic", "wendland")
# Greatest h |Σ V sin(k·r) ∇W| on a square or cubic lattice, h from 1.2 to 2 spacings.
STEEPEST = {"cubic": 1.11, "quintic": 1.33, "wendland": 1.16}

Kernel = Literal["cubic", "quintic", "wendland"]


class Smoothing(NamedTuple):
    """The numbers of one kernel at one smoothing length."""

    length: float  # m, h
    tiny: float  # m2, added to r² so that a particle does not divide by its distance from itself
    quintic: bool | None  # True if the kernel is the quintic spline, or None
    wendland: bool | None  # True if it is Wendland's, or None; without both the cubic spline
    height: float  # 1/m3, scale of W; in two dimensions 1/m2
    slope: float  # 1/m4, scale of dW/dr; of Wendland's 1/m5, of (dW/dr)/r

    @property
    def support(self) -> float:
        """Radius [m] beyond which W is 0."""
        return SUPPORT * self.length


def smoothing(kernel: Kernel, dimensions: int, length: float) -> Smoothing:
    """Choose a kernel.

    Parameters
    ----------
    kernel : "cubic", "quintic" or "wendland"
        Monaghan's cubic spline (1992), the quintic spline of Morris et al. (1997), or Wendland's of
        class C2 (1995).
    dimensions : int
        2 or 3.
    length : float, m
        The smoothing length h; W reaches as far as 2h.

    Returns
    -------
    Smoothing
        With ∫W dV = 1.
    """
    if kernel == "wendland":
        alpha = wendland.normalisation(dimensions, length)
        height, slope = alpha / 16.0, -0.625 * alpha / length**2
    elif kernel == "quintic":
        alpha = quintic_spline.normalisation(dimensions, length)
        height, slope = alpha / 32.0, -15.0 * alpha / (32.0 * length)
    else:
        alpha = cubic_spline.normalisation(dimensions, length)
        height, slope = 0.25 * alpha, -0.75 * alpha / length
    return Smoothing(
        length=length,
        tiny=TINY * length * length,
        quintic=True if kernel == "quintic" else None,
        wendland=True if kernel == "wendland" else None,
        height=height,
        slope=slope,
    )


@njit(inline="always")
def kernel(r2, smoothing):  # type: ignore[no-untyped-def]
    """W [1/m3] from r² [m2]; of the same root as the gradient, so that one serves both."""
    q = math.sqrt(r2 + smoothing.tiny) / smoothing.length
    if smoothing.wendland is not None:
        return smoothing.height * wendland.shape(q)
    if smoothing.quintic is not None:
        return smoothing.height * quintic_spline.shape(q)
    return smoothing.height * cubic_spline.shape(q)


@njit(inline="always")
def gradient(r2, per_r, smoothing):  # type: ignore[no-untyped-def]
    """(dW/dr)/r [1/m5], so that ∇_iW_ij = gradient · r_ij; finite where particles coincide.

    From r² [m2] and 1/r [1/m], of which Wendland's kernel needs none.
    """
    q = math.sqrt(r2 + smoothing.tiny) / smoothing.length
    if smoothing.wendland is not None:
        return smoothing.slope * wendland.slope(q)
    if smoothing.quintic is not None:
        return smoothing.slope * quintic_spline.slope(q) * per_r
    return smoothing.slope * cubic_spline.slope(q) * per_r


@njit(inline="always")
def with_length(smoothing, length, dimensions):  # type: ignore[no-untyped-def]
    """Return the same kernel at another smoothing length [m]."""
    ratio = smoothing.length / length
    scale = ratio * ratio * ratio if dimensions == 3 else ratio * ratio
    steeper = scale * ratio if smoothing.wendland is None else scale * ratio * ratio
    return Smoothing(
        length,
        smoothing.tiny / (ratio * ratio),
        smoothing.quintic,
        smoothing.wendland,
        smoothing.height * scale,
        smoothing.slope * steeper,
    )
