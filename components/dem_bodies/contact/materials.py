"""Materials in contact and their expected impacts; plain numbers, before any run.

With u = δ^{5/4} the damped Hertz contact is a linear oscillator in the phase plane (Antypov &
Elliott 2011). It ends where the force would become a pull, so that (Schwager & Pöschel 2007)

    e = exp(-2 ζ arccos ζ / √(1 - ζ²))

holds exactly; beyond ζ = 1 arccos ζ/√(1-ζ²) is arcosh ζ/√(ζ²-1).
"""

import math

DURATION = 2.9432  # tc v / δmax of a Hertz contact; Johnson, Contact Mechanics (1985), eq. 11.24
SPEED_UP = math.sqrt(1.875)  # ω δmax / v with ω² = S_n(δmax) / m*


def restitution(ζ: float) -> float:
    """Coefficient of restitution of a contact that is damped by the ratio ζ.

    References
    ----------
    Schwager & Pöschel (2007), Granular Matter 9, 465; Antypov & Elliott (2011), EPL 94, 50004.
    """
    if ζ < 1.0:
        ratio = math.acos(ζ) / math.sqrt(1.0 - ζ * ζ)
    else:
        ratio = math.acosh(ζ) / math.sqrt(ζ * ζ - 1.0) if ζ > 1.0 else 1.0
    return math.exp(-2.0 * ζ * ratio)


def damping_ratio(e: float) -> float:
    """Ratio ζ that realises the coefficient of restitution e, by halving."""
    low, high = 0.0, 1.0 / math.sqrt(e)  # restitution(1/√e) < e: it falls as 1/(4 ζ²)
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if restitution(middle) > e else (low, middle)
    return low


def effective_modulus(moduli: tuple[float, float], ratios: tuple[float, float]) -> float:
    """E* [Pa] of two materials: 1/E* = Σ (1-ν²)/E.

    Parameters
    ----------
    moduli : two float, Pa
        Young's moduli E.
    ratios : two float
        Poisson's ratios ν.

    Returns
    -------
    float, Pa

    References
    ----------
    Johnson (1985), Contact Mechanics, chapter 4.
    """
    return 1.0 / sum((1.0 - ν * ν) / E for E, ν in zip(moduli, ratios, strict=True))


def effective_shear(moduli: tuple[float, float], ratios: tuple[float, float]) -> float:
    """G* [Pa] of two materials: 1/G* = Σ (2-ν)/G with G = E/(2(1+ν)).

    Parameters
    ----------
    moduli : two float, Pa
        Young's moduli E.
    ratios : two float
        Poisson's ratios ν.

    Returns
    -------
    float, Pa

    References
    ----------
    Mindlin & Deresiewicz (1953), J. Appl. Mech. 20, 327.
    """
    pairs = zip(moduli, ratios, strict=True)
    return 1.0 / sum((2.0 - ν) * 2.0 * (1.0 + ν) / E for E, ν in pairs)


def impact_frequency(modulus: float, radius: float, mass: float, speed: float) -> float:
    """Return ω = √(S_n/m*) [rad/s] at the deepest point of an impact.

    Parameters
    ----------
    modulus : float, Pa
        E*.
    radius : float, m
        R*.
    mass : float, kg
        m*.
    speed : float, m/s

    Returns
    -------
    float, rad/s

    References
    ----------
    Johnson (1985), Contact Mechanics, eq. 11.23: δmax = [15 m* v² / (16 E* √R*)]^{2/5}.
    """
    depth = (15.0 * mass * speed**2 / (16.0 * modulus * math.sqrt(radius))) ** 0.4
    return SPEED_UP * speed / depth
