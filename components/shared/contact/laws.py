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

from quintet.components.shared.numba_options import LANEWISE


@njit(**LANEWISE)
def layer_law(area, layer, element, scale, depth):  # type: ignore[no-untyped-def]
    """Force and stiffness of a particle of a layer, pressed into a face by a depth [m].

    Parameters
    ----------
    area : float, m2
        Of the particle.
    layer, element : float, m/Pa
        h/M of the layers of particles and of elements.
    scale : float, 1
        f.

    Returns
    -------
    As `sphere_law`.
    """
    stiff = scale * area / (layer + element)
    return stiff * depth, 0.5 * stiff * depth * depth, stiff, stiff, 0.0


@njit(**LANEWISE)
def sphere_law(radius, mass, inverse_moment, modulus, shear, friction, depth, closing):  # type: ignore[no-untyped-def]
    """Force and stiffness of a sphere pressed into a face, and largest ones in the coming impact.

    Parameters
    ----------
    radius, mass, inverse_moment : float, m, kg and 1/(kg m2)
    modulus, shear : float, Pa
        f E* and f G*.
    friction : float, 1
        Coefficient.
    depth, closing : float, m and m/s
        Present overlap, and the velocity at which it grows.

    Returns
    -------
    push, stored : float, N and J
        Normal force, and its energy.
    side : float, N/m
        Stiffness along the face.
    largest_stiffness : float, N/m
        Largest stiffness along the normal, as deep as the particle may come.
    tangential_square : float, 1/s2
        ω² of a sphere that sticks and turns; 0 without friction.
    """
    stiff, ratio = hertz_stiffness(modulus, radius, depth), 4.0 * shear / modulus
    push, largest_overlap = (
        2.0 / 3.0 * stiff * depth,
        deepest_overlap(depth, closing, modulus, radius, mass),
    )
    largest_stiffness, tangential_square = hertz_stiffness(modulus, radius, largest_overlap), 0.0
    if friction > 0.0:
        tangential_square = (
            ratio * largest_stiffness * (1.0 / mass + radius * radius * inverse_moment)
        )
    return push, 0.4 * push * depth, ratio * stiff, largest_stiffness, tangential_square


@njit(**LANEWISE)
def in_series(modulus_i, modulus_j):  # type: ignore[no-untyped-def]
    """Modulus [Pa] of two that act one behind the other: 1/M = 1/M_i + 1/M_j."""
    return modulus_i * modulus_j / (modulus_i + modulus_j)


@njit(**LANEWISE)
def hertz_stiffness(modulus, radius, depth):  # type: ignore[no-untyped-def]
    """S_n [N/m] of moduli E* [Pa], a radius [m] and an overlap [m]; Johnson (1985), eq. 4.23."""
    return 2.0 * modulus * math.sqrt(radius * depth)


@njit(**LANEWISE)
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


@njit(**LANEWISE)
def change_stiffness(slip, held, i, stiff):  # type: ignore[no-untyped-def]
    """Change the stiffness of a tangential spring; return the energy [J] that is lost.

    A stiffer spring keeps its force and a softer one its stretch, so that energy is lost, never
    gained (Walton & Braun, J. Rheol. 30 (1986) 949).

    Parameters
    ----------
    slip : (n, 3) float array, m
        Stretches of springs; that of a stiffer one is shortened.
    held : (n,) float array, J
        What they held with their former stiffness.
    i : int
        Which one.
    stiff : float, N/m
        Present stiffness.
    """
    square = slip[i, 0] * slip[i, 0] + slip[i, 1] * slip[i, 1] + slip[i, 2] * slip[i, 2]
    if stiff * square > 2.0 * held[i]:
        share = 2.0 * held[i] / (stiff * square)
        for d in range(3):
            slip[i, d] *= share
        square *= share * share
    return held[i] - 0.5 * stiff * square


@njit(**LANEWISE)
def friction(slip, i, slid, n, stiff, limit):  # type: ignore[no-untyped-def]
    """Stretch a tangential spring by a step's motion, within Coulomb's limit.

    Parameters
    ----------
    slip : (n, 3) float array, m
        Stretches of springs; that of number i is changed.
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
        beyond the change of the spring's energy. What the spring held along the normal, which has
        turned since, is dissipated too.
    """
    along, moved = 0.0, 0.0
    for d in range(3):
        along, moved = along + slip[i, d] * n[d], moved + slid[d] * n[d]
    square = 0.0
    for d in range(3):
        slip[i, d] -= along * n[d]
        slid[d] -= moved * n[d]
        square += (slip[i, d] + slid[d]) ** 2
    stretch, share = math.sqrt(square), 1.0
    if stiff * stretch > limit:
        share = limit / (stiff * stretch)
    energy, dissipated = 0.0, 0.5 * stiff * along * along
    for d in range(3):
        tried = slip[i, d] + slid[d]
        stretched = share * tried
        dissipated += 0.5 * stiff * (slip[i, d] + stretched) * (tried - stretched)
        energy += 0.5 * stiff * stretched * stretched
        slip[i, d] = stretched
    return energy, dissipated
