"""Physics of one contact between a particle and a face.

Layers of particles touch by a penalty force, whose stiffness follows the segment-based formula
k = f K A²/V of LS-DYNA's Theory Manual, section 29.5 (Hallquist, Gladman & Goudreau 1985; Benson &
Hallquist, Comput. Methods Appl. Mech. Eng. 78 (1990) 141), with V = A h and the longitudinal
modulus M = K + 4G/3 in the place of K, as both layers are pressed between their neighbours. The
layers of both sides act one behind the other:

    k = f A / (h_i/M_i + h_j/M_j)

Spheres touch by Hertz's force, with Mindlin's stiffness along the face (Hertz 1882; Mindlin &
Deresiewicz, J. Appl. Mech. 20 (1953) 327):

    F = 2/3 S_n δ,  S_n = 2 f E* √(R δ),  S_t = 8 f G* √(R δ),  1/E* = Σ (1-ν²)/E,  1/G* = Σ (2-ν)/G

Coulomb's law limits the spring along the face (Cundall & Strack, Géotechnique 29 (1979) 47).
"""

import math

from numba import njit

from quintet.components.shared.numba_options import INNER


@njit(**INNER)
def contact_stiffness(area, spacing, modulus_i, thickness, modulus_j, scale):  # type: ignore[no-untyped-def]
    """Stiffness [N/m] between a particle i and a face j.

    Parameters
    ----------
    area : float, m2
        Of the particle.
    spacing, thickness : float, m
        Of the layers of particles and of elements.
    modulus_i, modulus_j : float, Pa
        Longitudinal.
    scale : float, 1
        f.
    """
    return scale * area / (spacing / modulus_i + thickness / modulus_j)


@njit(**INNER)
def in_series(modulus_i, modulus_j):  # type: ignore[no-untyped-def]
    """Modulus [Pa] of two that act one behind the other: 1/M = 1/M_i + 1/M_j."""
    return modulus_i * modulus_j / (modulus_i + modulus_j)


@njit(**INNER)
def hertz_stiffness(modulus, radius, depth):  # type: ignore[no-untyped-def]
    """S_n [N/m] of moduli E* [Pa], a radius [m] and an overlap [m]; Johnson (1985), eq. 4.23."""
    return 2.0 * modulus * math.sqrt(radius * depth)


@njit(**INNER)
def deepest_overlap(depth, closing, modulus, radius, mass):  # type: ignore[no-untyped-def]
    """Overlap [m] at which Hertz's force stops a sphere before a body at rest.

    δ_max^{5/2} = δ^{5/2} + 15 m v² / (16 E* √R); Johnson (1985), eq. 11.23.

    Parameters
    ----------
    depth, closing : float, m and m/s
        Present overlap, and the velocity at which it grows.
    modulus, radius, mass : float, Pa, m and kg
        E*, R and m.
    """
    if closing <= 0.0:
        return depth
    stopped = 15.0 * mass * closing * closing / (16.0 * modulus * math.sqrt(radius))
    return (depth**2.5 + stopped) ** 0.4


@njit(**INNER)
def stretch_anew(slip, held, stiff):  # type: ignore[no-untyped-def]
    """Energy [J] that a spring holds as its stiffness [N/m] changes; shorten a stiffer spring.

    A stiffer spring keeps its force and a softer one its stretch, so that energy is lost, never
    gained (Walton & Braun, J. Rheol. 30 (1986) 949).

    Parameters
    ----------
    slip : (3,) float array, m
        Stretch of the spring; changed.
    held : float, J
        That it held with its former stiffness.
    stiff : float, N/m
        Present stiffness.
    """
    square = slip[0] * slip[0] + slip[1] * slip[1] + slip[2] * slip[2]
    if stiff * square > 2.0 * held:
        share = 2.0 * held / (stiff * square)
        for d in range(3):
            slip[d] *= share
        square *= share * share
    return 0.5 * stiff * square


@njit(**INNER)
def friction(slip, slid, n, stiff, limit):  # type: ignore[no-untyped-def]
    """Stretch the tangential spring by a step's motion, within Coulomb's limit.

    Parameters
    ----------
    slip : (3,) float array, m
        Stretch of the spring; changed.
    slid : (3,) float array, m
        Motion of the particle over the face in the step.
    n : (3,) float array
        Unit normal.
    stiff : float, N/m
        Of the spring.
    limit : float, N
        μ F_n.

    Returns
    -------
    energy, dissipated : float, J
        In the spring, and by slip: ½ k (ξ₀ + ξ₁)·(ξ₀ + Δ - ξ₁), which is what the mean force does
        beyond the change of the spring's energy.
    """
    along, moved = 0.0, 0.0
    for d in range(3):
        along, moved = along + slip[d] * n[d], moved + slid[d] * n[d]
    square = 0.0
    for d in range(3):
        slip[d] -= along * n[d]
        slid[d] -= moved * n[d]
        square += (slip[d] + slid[d]) ** 2
    stretch, share = math.sqrt(square), 1.0
    if stiff * stretch > limit:
        share = limit / (stiff * stretch)
    energy, dissipated = 0.0, 0.0
    for d in range(3):
        tried = slip[d] + slid[d]
        stretched = share * tried
        dissipated += 0.5 * stiff * (slip[d] + stretched) * (tried - stretched)
        energy += 0.5 * stiff * stretched * stretched
        slip[d] = stretched
    return energy, dissipated
