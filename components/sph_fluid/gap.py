"""Films of water in narrow gaps; imported only by a scene that asks.

Between two faces nearer than WIDEST spacings lies a film that the particles do not show, or not
wholly. It is filled from its rim, where it has the pressure of the fluid outside (none where that
is dry), and pushes its faces apart, one as much as the other. Reynolds' equation of lubrication,

    ∂(θw)/∂t = ∇·(K ∇(p - ρ₀ g·r)),    K = w³/(12μ),    p ≥ 0,  θ ≤ 1,  p (1 - θ) = 0,

says how fast the share θ of the width w that is full of water grows, and with which pressure: a
film that is not full has none (Elrod, ASME J. Lubr. Technol. 103 (1981) 350), faces that part
draw it down and faces that close press it up. Water does not flow in faster than the pressure at
the rim can drive it, √(2p/ρ₀): this bounds K in wide gaps. The film's own mass is left out.

Particles get into gaps of half a spacing and more, but the kernel reaches through a gap and finds
less water there than in the open. Per area of a flat face, fluid of pressure p presses with

    2p Σ_j V_j W(r_face - r_j),

the sum over columns of samples below it of what pairs give, ∫∂W/∂z dz = W. Summed over all but
the body itself this is p. So the film presses with its own pressure on that part of it alone which
particles leave, as many of them as there are in the gap, and nothing is pressed twice.
"""

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import FAST
from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.smoothing.smoothing import kernel
from quintet.components.sph_fluid.facing import WIDEST, Film, directions
from quintet.components.sph_fluid.laws import Fluid
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import Array, State, Whole

FADING = 0.85  # spacings below WIDEST over which films fade out, as particles get in and press
WATER = 1e-3  # Pa s, its viscosity
LARGEST = 0.1  # of the speed of sound, velocity: a pressure above ρu² is sound, not flow
SWEEPS = 20  # over the film in each step; it starts from the last step's pressure


@njit(**FAST)
def flow(
    rim: Array, begin: Whole, near: Whole, width: Array, ease: Array, place: Array,
    outside: Array, stored: Array, cell: float, weight: tuple[float, float, float],
    sweeps: int, pressure: Array, share: Array,
) -> None:  # fmt: skip
    """Write pressure [Pa] and full share of a film at a step's end, by Gauss and Seidel.

    `ease` is K [m4 s/kg], `stored` the water per area at the step's beginning [m], `cell` the area
    of a sample over the step [m2/s], `weight` ρ₀ g.
    """
    for i in range(rim.shape[0]):
        if rim[i]:
            pressure[i] = outside[i]
            share[i] = 1.0 if outside[i] > 0.0 else 0.0
    for _ in range(sweeps):
        for i in range(rim.shape[0]):
            if rim[i]:
                continue
            brought, paths = 0.0, 0.0
            for k in range(begin[i], begin[i + 1]):
                j = near[k]
                path = 0.5 * (ease[i] + ease[j])
                head = 0.0
                for d in range(3):
                    head += weight[d] * (place[i, d] - place[j, d])
                # What is not full has no pressure to drive anything out.
                if pressure[j] > 0.0:
                    brought += path * (pressure[j] + head)
                paths += path
            full = brought - cell * (width[i] - stored[i])
            pressure[i] = max(full / paths, 0.0) if paths > 0.0 else 0.0
            filled = (stored[i] + brought / cell) / width[i]
            share[i] = 1.0 if pressure[i] > 0.0 else min(filled, 1.0)


@njit(**FAST)
def pressed(
    row: Whole, face: Array, split: int, place: Array, near: Lists, fluid: Fluid, share: Array
) -> None:
    """Write Σ V W of the fluid around points (m, 3) m of faces, by the lists of mirror points."""
    begin, _, end, neighbour = near
    for s in range(row.shape[0]):
        i = split + row[s]
        share[s] = 0.0
        for k in range(np.uint64(begin[i]), np.uint64(end[i])):
            j = np.uint64(neighbour[k])
            r2 = 0.0
            for d in range(3):
                r2 += (face[s, d] - place[j, d]) ** 2
            share[s] += kernel(r2, fluid.smoothing) * fluid.mass / place[j, 3]


def push(
    film: Film, state: State, near: Lists, dt: float, params: SphFluidParams, fluid: Fluid
) -> None:
    """Advance the film by a step [s], and add its push to the samples' force."""
    spacing, density = params.spacing, params.density
    place, mirror = state.place[state.fluid :], state.mirror
    off, back = (mirror[row] - place[row, :3] for row in (film.row, film.across))
    away = directions(off, back)
    below, beyond = (np.einsum("nd,nd->n", one, away) for one in (off, back))
    foot = place[film.row, :3] + 0.5 * below[:, None] * away
    gap = np.einsum("nd,nd->n", foot - place[film.across, :3], away) - 0.5 * beyond
    width = np.maximum(gap, params.boundary.roughness)
    weight = density * np.array(params.gravity)
    outside = state.motion[state.fluid + film.row, 3] * place[film.row, 3] ** 2
    outside = np.where(outside > 0.0, outside + (foot - place[film.row, :3]) @ weight, 0.0)
    outside = np.minimum(outside, density * (LARGEST * params.sound_speed) ** 2)
    driving = max(float(outside[film.rim].max(initial=0.0)), 1.0)
    bound = width * film.size * np.sqrt(2.0 / (density * driving))
    ease = np.minimum(width**3 / (12.0 * WATER), bound)
    pressure, share, before = state.film[film.sample].T.copy()
    known = before > 0.0
    stored = np.where(known, share * before, 0.0)
    arrays = (film.rim, film.begin, film.near, width, ease, foot, outside, stored)
    x, y, z = weight.tolist()
    flow(*arrays, spacing**2 / dt, (x, y, z), SWEEPS, pressure, share)
    state.film[:] = 0.0
    state.film[film.sample] = np.stack([pressure, share, width], axis=1)
    wet = np.empty(len(gap))
    pressed(film.row, foot, state.fluid, state.place, near, fluid, wet)
    left = 2.0 * np.maximum(1.0 - film.own - wet, 0.0)
    left *= np.clip((WIDEST - width / spacing) / FADING, 0.0, 1.0)
    force = (pressure * left * film.area)[:, None] * away
    np.add.at(state.force, film.sample, force)
    bodies = film.facing >= 0
    np.add.at(state.force, film.facing[bodies], -force[bodies])
