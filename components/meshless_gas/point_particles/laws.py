"""Drag and heat of a sphere in a gas.

Drag is told as a factor f over that of Stokes, C_D = 24 f/Re, which is finite at rest; M/Re as a
number of its own (that of Knudsen but for a constant), for it is known at rest too.
"""

import math

from numba import njit

from quintet.components.shared.numba_options import EXACT, INNER

STOKES, CLIFT_GAUVIN, HENDERSON, LOTH = range(4)
DRAG = {"stokes": STOKES, "clift_gauvin": CLIFT_GAUVIN, "henderson": HENDERSON, "loth": LOTH}
STILL, RANZ_MARSHALL, FOX = range(3)
HEAT = {"still": STILL, "ranz_marshall": RANZ_MARSHALL, "fox": FOX}
NEXUS = 45.0  # Reynolds number below which rarefaction rules, above which compressibility does
CREEPING = 1e-3  # Mach number below which free molecules add less than rounding


@njit(**INNER)
def clift_gauvin(reynolds: float) -> float:
    """Drag over that of Stokes in an incompressible flow.

    Parameters
    ----------
    reynolds : float, 1
        Of the diameter, below 3·10⁵.

    References
    ----------
    Clift & Gauvin, Proc. Chemeca 70 (1970) 14.
    """
    newton = 0.42 / (1.0 + 42500.0 * reynolds**-1.16) if reynolds > 0.0 else 0.0
    return 1.0 + 0.15 * reynolds**0.687 + reynolds / 24.0 * newton


@njit(**INNER)
def henderson(reynolds: float, mach: float, rarefied: float, warmth: float, gamma: float) -> float:
    """Drag over that of Stokes, from continuum to free molecules, to M = 6.

    Parameters
    ----------
    reynolds, mach : float, 1
        Of the velocity against the gas.
    rarefied : float, 1
        M/Re.
    warmth : float, 1
        Temperature of the sphere over that of the gas.
    gamma : float, 1

    References
    ----------
    Henderson, AIAA J. 14 (1976) 707: below M = 1, above 1.75, and a line between.
    """
    if mach <= 1.0:
        return slower(reynolds, mach, rarefied, warmth, gamma)
    if mach >= 1.75:
        return faster(reynolds, mach, rarefied, warmth, gamma)
    # Both ends at the Reynolds number of the flow; as coefficients, thus as factors.
    low = slower(reynolds, 1.0, 1.0 / reynolds, warmth, gamma)
    high = faster(reynolds, 1.75, 1.75 / reynolds, warmth, gamma)
    return low + (mach - 1.0) / 0.75 * (high - low)


@njit(**INNER)
def slower(reynolds: float, mach: float, rarefied: float, warmth: float, gamma: float) -> float:
    """Drag over that of Stokes below the speed of sound; as `henderson`."""
    speed = math.sqrt(0.5 * gamma)  # molecular speed ratio over Mach number
    slip = rarefied * speed
    reflected = (3.65 - 1.53 * warmth) / (1.0 + 0.353 * warmth)
    fade = math.exp(-0.247 / slip) if slip > 0.0 else 0.0
    creeping = 1.0 / (1.0 + slip * (4.33 + reflected * fade))
    wake = 0.03 * reynolds + 0.48 * math.sqrt(reynolds)
    inertial = (4.5 + 0.38 * wake) / (1.0 + wake) + 0.1 * mach**2 + 0.2 * mach**8
    inertial *= math.exp(-0.5 * math.sqrt(mach * rarefied))
    free = 0.6 * mach * speed * (1.0 - math.exp(-rarefied))
    return creeping + reynolds / 24.0 * (inertial + free)


@njit(**INNER)
def faster(reynolds: float, mach: float, rarefied: float, warmth: float, gamma: float) -> float:
    """Drag over that of Stokes above M = 1.75; as `henderson`."""
    speed = mach * math.sqrt(0.5 * gamma)
    layer = 1.86 * math.sqrt(rarefied)
    square = speed * speed
    free = 2.0 + 2.0 / square + 1.058 / speed * math.sqrt(warmth) - 1.0 / (square * square)
    return reynolds / 24.0 * (0.9 + 0.34 / (mach * mach) + layer * free) / (1.0 + layer)


@njit(**INNER)
def loth(reynolds: float, mach: float, rarefied: float, gamma: float) -> float:
    """Drag over that of Stokes, from continuum to free molecules, to hypersonic speeds.

    Parameters
    ----------
    reynolds, mach : float, 1
        Of the velocity against the gas.
    rarefied : float, 1
        M/Re.
    gamma : float, 1

    References
    ----------
    Loth, Daspit, Jeong, Nagata & Nonomura, AIAA J. 59 (2021) 3261; a sphere as warm as the gas.
    """
    if reynolds <= NEXUS:
        return rarefaction(reynolds, mach, rarefied, gamma)
    return compression(reynolds, mach)


@njit(**INNER)
def compression(reynolds: float, mach: float) -> float:
    """Drag over that of Stokes above the nexus; as `loth`."""
    if mach < 1.5:
        c = 1.65 + 0.65 * math.tanh(4.0 * mach - 3.4)
    else:
        c = 2.18 - 0.13 * math.tanh(0.9 * mach - 2.7)
    if mach < 0.8:
        g = 166.0 * mach**3 + 3.29 * mach**2 - 10.9 * mach + 20.0
    else:
        g = 5.0 + 40.0 / mach**3
    if mach < 1.0:
        h = 0.0239 * mach**3 + 0.212 * mach**2 - 0.074 * mach + 1.0
    else:
        h = 0.93 + 1.0 / (3.5 + mach**5)
    newton = 0.42 * c / (1.0 + 42500.0 / reynolds ** (1.16 * c) + g / math.sqrt(reynolds))
    return (1.0 + 0.15 * reynolds**0.687) * h + reynolds / 24.0 * newton


@njit(**INNER)
def rarefaction(reynolds: float, mach: float, rarefied: float, gamma: float) -> float:
    """Drag over that of Stokes below the nexus; as `loth`."""
    knudsen = math.sqrt(0.5 * math.pi * gamma) * rarefied
    slip = 2.514 + (0.8 * math.exp(-0.55 / knudsen) if knudsen > 0.0 else 0.0)
    creeping = (1.0 + 0.15 * reynolds**0.687) / (1.0 + knudsen * slip)
    if mach < CREEPING:
        return creeping
    s = mach * math.sqrt(0.5 * gamma)
    free = (1.0 + 2.0 * s * s) * math.exp(-s * s) / (s**3 * math.sqrt(math.pi))
    free += (4.0 * s**4 + 4.0 * s * s - 1.0) * math.erf(s) / (2.0 * s**4)
    free += 2.0 / (3.0 * s) * math.sqrt(math.pi)
    if mach <= 1.0:
        j = 2.26 - 0.1 / mach + 0.14 / mach**3
    else:
        j = 1.6 + 0.25 / mach + 0.11 / mach**2 + 0.44 / mach**3
    free /= 1.0 + (free / j - 1.0) * math.sqrt(reynolds / NEXUS)
    share = mach**4 / (1.0 + mach**4)
    return creeping * (1.0 - share) + share * reynolds / 24.0 * free


@njit(**EXACT)
def drag_factor(
    law: int, reynolds: float, mach: float, rarefied: float, warmth: float, gamma: float
) -> float:
    """Drag over that of Stokes by one of the laws; as `henderson`.

    Parameters
    ----------
    law : int
        One of `DRAG`.
    reynolds, mach, rarefied, warmth, gamma : float, 1
    """
    if law == LOTH:
        return loth(reynolds, mach, rarefied, gamma)
    if law == HENDERSON:
        return henderson(reynolds, mach, rarefied, warmth, gamma)
    if law == CLIFT_GAUVIN:
        return clift_gauvin(reynolds)
    return 1.0


@njit(**EXACT)
def nusselt(law: int, reynolds: float, mach: float, rarefied: float, prandtl: float) -> float:
    """Heat flow over π λ d (T - T_p).

    Parameters
    ----------
    law : int
        One of `HEAT`; still gas has 2.
    reynolds, mach, rarefied, prandtl : float, 1
        `rarefied` is M/Re.

    References
    ----------
    Ranz & Marshall, Chem. Eng. Prog. 48 (1952) 141. Fox, Rackett & Nicholls, Shock Tube and Shock
    Wave Research (1978) 262: compressible, with free molecules.
    """
    if law == RANZ_MARSHALL:
        return 2.0 + 0.6 * math.sqrt(reynolds) * prandtl ** (1.0 / 3.0)
    if law == FOX:
        still = 2.0 * math.exp(-mach) / (1.0 + 17.0 * rarefied)
        moving = 0.459 * prandtl**0.33 * reynolds**0.55
        return still + moving * (1.0 + 0.5 * math.exp(-17.0 * rarefied)) / 1.5
    return 2.0
