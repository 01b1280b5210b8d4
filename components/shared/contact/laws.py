"""Physics of one contact between a particle and a face.

The penalty stiffness follows the segment-based formula k = f K A²/V of LS-DYNA's Theory Manual,
section 29.5 (Hallquist, Gladman & Goudreau 1985; Benson & Hallquist, Comput. Methods Appl. Mech.
Eng. 78 (1990) 141), with V = A h and the longitudinal modulus M = K + 4G/3 in the place of K, as
both layers are pressed between their neighbours. The layers of both sides act one behind the other:

    k = f A / (h_i/M_i + h_j/M_j)

A spring along the normal, and one along the face that Coulomb's law limits (Cundall & Strack,
Géotechnique 29 (1979) 47).
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
def friction(slip, slid, n, stiff, limit):  # type: ignore[no-untyped-def]
    """Stretch the tangential spring by a step's motion, within Coulomb's limit.

    Spring and normal are equally stiff.

    Parameters
    ----------
    slip : (3,) float array, m
        Stretch of the spring; changed.
    slid : (3,) float array, m
        Motion of the particle over the face in the step.
    n : (3,) float array
        Unit normal.
    stiff : float, N/m
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
