"""Loops over particles and their neighbours; each row is written by one call alone."""

import math

import numpy as np
from numba import njit, types
from numba.extending import overload

from quintet.components.shared.numba_options import EXACT, FAST
from quintet.components.shared.packing import (
    empty_rows,
    longest_list,
    out_of_reach,
    pack_rows,
    pack_values,
)
from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.smoothing.cubic_spline import ONE
from quintet.components.shared.smoothing.smoothing import gradient, kernel
from quintet.components.sph_fluid.laws import (
    Contact,
    Diffusion,
    Fluid,
    Friction,
    Guard,
    bear,
    inverses,
    pressure_term,
    push,
    repel,
    spread,
)
from quintet.components.sph_fluid.state import Array, Whole


# Numbers from 0 on are in the order of their bits, and the compiler makes vectors of the greatest
# of integers, but not of that of floats: with it the loop would be half as fast.
def bits(number):  # type: ignore[no-untyped-def]
    """Bits of a number, as an integer as wide."""


def number(bits):  # type: ignore[no-untyped-def]
    """Number that has these bits."""


@overload(bits, inline="always")
def _bits(number):  # type: ignore[no-untyped-def]
    if number == types.float32:
        return lambda number: np.float32(number).view(np.int32)
    return lambda number: np.float64(number).view(np.int64)


@overload(number, inline="always")
def _number(bits):  # type: ignore[no-untyped-def]
    if bits == types.int32:
        return lambda bits: np.int32(bits).view(np.float32)
    return lambda bits: np.int64(bits).view(np.float64)


@njit(**FAST)
def interact(
    first: int, last: int, split: int, place: Array, motion: Array, near: Lists,
    fluid: Fluid, gravity: tuple[float, float, float], rate: Array, drift: Array | None,
    diffusion: Diffusion | None, friction: Friction | None, guard: Guard | None,
    contact: Contact | None, bulk: Array | None, squeeze: Array | None,
) -> tuple[float, float]:  # fmt: skip
    """Write acceleration and dρ/dt of rows [first, last); return the greatest a² and |u·r|/r².

    With `drift`, write Σ_j (m_j/ρ̄_ij)(u_j - u_i)W_ij over the fluid too (Monaghan 1989); with
    `diffusion`, let density spread in the fluid (Fourtakas et al. 2019); with `friction`, let the
    fluid be viscous (Lo & Shao 2002, or Monaghan & Gingold 1983); with `guard`, let walls repel
    what is about to pass between their particles; with `contact`, let the contact potential stand
    for the walls' pressure; with `bulk`, let boundary particles weigh that many times as much as
    those of the fluid; with `squeeze`, write dρ/dt without diffusion. What is None is left out.
    """
    begin, middle, end, neighbour = near
    nil = place.dtype.type(0)  # sums are as precise as what they are summed from
    beside = empty_rows(longest_list(first, last, begin, end), 4, place.dtype)
    moving, seen = np.empty_like(beside), np.empty_like(beside)
    share, some = np.ones_like(beside[:, 0]), np.ones_like(beside[:, 0])
    greatest, fastest = 0.0, bits(nil)
    for i in range(first, last):
        here = place[i, 0], place[i, 1], place[i, 2], place[i, 3]
        going = motion[i, 0], motion[i, 1], motion[i, 2], motion[i, 3]
        out = out_of_reach(here[0], fluid.smoothing.length), here[1], here[2], here[3]
        if i < split:
            count = pack_rows(begin[i], middle[i], neighbour, place, out, beside)
            pack_rows(begin[i], middle[i], neighbour, motion, going, moving)
            ax, ay, az, growth, flow, mx, my, mz, fastest = meet(
                count, here, going, beside, moving, moving, share, ONE, fluid, drift, diffusion,
                friction, None, None, None, None, fastest,
            )  # fmt: skip
            if drift is not None:
                drift[i, 0] = 2.0 * fluid.mass * mx
                drift[i, 1] = 2.0 * fluid.mass * my
                drift[i, 2] = 2.0 * fluid.mass * mz
            if middle[i] < end[i]:
                count = pack_rows(middle[i], end[i], neighbour, place, out, beside)
                pack_rows(middle[i], end[i], neighbour, motion, going, moving)
                if friction is not None:
                    pack_rows(middle[i], end[i], neighbour, friction.seen, going, seen)
                if bulk is not None:
                    pack_values(middle[i], end[i], neighbour, bulk, share)
                held = None
                if contact is not None:
                    held = pack_values(middle[i], end[i], neighbour, contact.some, some)
                bx, by, bz, more, other, _, _, _, fastest = meet(
                    count, here, going, beside, moving, seen, share, fluid.grip, fluid, None, None,
                    friction, guard, contact, held, bulk, fastest,
                )  # fmt: skip
                ax, ay, az = ax + bx, ay + by, az + bz
                growth, flow = growth + more, flow + other
            fx = fluid.mass * ax + gravity[0]
            fy = fluid.mass * ay + gravity[1]
            fz = fluid.mass * az + gravity[2]
            greatest = max(greatest, fx * fx + fy * fy + fz * fz)
            rate[i, 0] = fx
            rate[i, 1] = fy
            rate[i, 2] = fz
        else:
            count = pack_rows(begin[i], end[i], neighbour, place, out, beside)
            pack_rows(begin[i], end[i], neighbour, motion, going, moving)
            growth = flow = close(count, here, going, beside, moving, fluid)
        rate[i, 3] = fluid.mass * growth
        if squeeze is not None:
            squeeze[i] = fluid.mass * flow
    return greatest, number(fastest)


@njit(inline="always")
def close(count, here, going, beside, moving, fluid):  # type: ignore[no-untyped-def]
    """Σ u_ij·∇_iW_ij of a boundary particle over so many of the fluid around it."""
    x, y, z, _ = here
    u, v, w, _ = going
    growth = beside.dtype.type(0)
    for k in range(count):
        dx, dy, dz = x - beside[k, 0], y - beside[k, 1], z - beside[k, 2]
        dot = dx * (u - moving[k, 0]) + dy * (v - moving[k, 1]) + dz * (w - moving[k, 2])
        r2 = dx * dx + dy * dy + dz * dz
        per_r = ONE / math.sqrt(r2 + fluid.smoothing.tiny)
        growth += dot * gradient(r2, per_r, fluid.smoothing)
    return growth


@njit(inline="always")
def meet(  # type: ignore[no-untyped-def]
    count, here, going, beside, moving, seen, share, grip, fluid, drift, diffusion, friction, guard,
    contact, held, bulk, fastest,
):  # fmt: skip
    """Sums over so many neighbours: force over m² (3), growth, flow, XSPH's (3), greatest bits.

    The flow is Σ u_ij·∇_iW_ij, the growth that and diffusion. Friction sees velocities `seen`;
    `grip` is the share of viscosity that acts, `held` says which neighbours the contact potential
    holds (None: all) and, with `bulk`, `share` how many times as much as a particle each weighs.
    """
    nil = beside.dtype.type(0)
    x, y, z, density = here
    u, v, w, term = going
    more = density + fluid.base + fluid.base
    ax, ay, az, growth, flow = nil, nil, nil, nil, nil
    mx, my, mz = nil, nil, nil
    for k in range(count):
        dx, dy, dz = x - beside[k, 0], y - beside[k, 1], z - beside[k, 2]
        du, dv, dw = u - moving[k, 0], v - moving[k, 1], w - moving[k, 2]
        r2 = dx * dx + dy * dy + dz * dz
        dot = dx * du + dy * dv + dz * dw
        both = more + beside[k, 3]
        per_r, per_r2, per_both = inverses(r2, both, fluid)
        closing = dot * per_r2
        slope = gradient(r2, per_r, fluid.smoothing)
        if bulk is not None:
            slope *= share[k]
        fastest = max(fastest, bits(abs(closing)))
        growth += dot * slope
        flow += dot * slope
        terms = term + moving[k, 3]
        if contact is not None:
            terms = term + moving[k, 3] * bear(r2, k, held, contact, fluid)
        force = slope * push(terms, grip * closing, per_both, fluid)
        if guard is not None:
            force -= repel(r2, guard)
        ax -= force * dx
        ay -= force * dy
        az -= force * dz
        if diffusion is not None:
            flux = spread(beside[k, 3] - density, dx, dy, dz, diffusion)
            growth -= flux * slope * (r2 * per_r2 * per_both)
        if friction is not None:
            ru, rv, rw = u - seen[k, 0], v - seen[k, 1], w - seen[k, 2]
            if friction.stress is not None:
                rub = dx * ru + dy * rv + dz * rw
                rub *= friction.strength * grip * slope * per_r2 * per_both
                ax += rub * dx
                ay += rub * dy
                az += rub * dz
            else:
                shear = friction.strength * grip * slope * (r2 * per_r2 * per_both)
                ax += shear * ru
                ay += shear * rv
                az += shear * rw
        if drift is not None:
            weight = kernel(r2, fluid.smoothing) * per_both
            mx -= weight * du
            my -= weight * dv
            mz -= weight * dw
    return ax, ay, az, growth, flow, mx, my, mz, fastest


@njit(**FAST)
def push_samples(
    first: int, last: int, row: Whole, listed: Whole, place: Array, motion: Array, near: Lists,
    fluid: Fluid, friction: Friction | None, guard: Guard | None, contact: Contact | None,
    bulk: Array | None, force: Array,
) -> None:  # fmt: skip
    """Write the force on surface samples: pair by pair, minus that on the fluid [N]."""
    begin, _, end, neighbour = near
    nil = place.dtype.type(0)
    for s in range(first, last):
        i = row[s]
        x, y, z, density = place[i, 0], place[i, 1], place[i, 2], place[i, 3]
        u, v, w, term = motion[i, 0], motion[i, 1], motion[i, 2], motion[i, 3]
        fx, fy, fz = nil, nil, nil
        for k in range(np.uint64(begin[listed[s]]), np.uint64(end[listed[s]])):
            j = np.uint64(neighbour[k])
            dx, dy, dz = x - place[j, 0], y - place[j, 1], z - place[j, 2]
            r2 = dx * dx + dy * dy + dz * dz
            du, dv, dw = u - motion[j, 0], v - motion[j, 1], w - motion[j, 2]
            dot = dx * du + dy * dv + dz * dw
            both = density + place[j, 3] + fluid.base + fluid.base
            per_r, per_r2, per_both = inverses(r2, both, fluid)
            closing = fluid.grip * dot * per_r2
            slope = gradient(r2, per_r, fluid.smoothing)
            if bulk is not None:
                slope *= bulk[i]
            terms = term + motion[j, 3]
            if contact is not None:
                terms = term * bear(r2, i, contact.some, contact, fluid) + motion[j, 3]
            size = slope * push(terms, closing, per_both, fluid)
            if guard is not None:
                size -= repel(r2, guard)
            fx -= size * dx
            fy -= size * dy
            fz -= size * dz
            if friction is not None and friction.stress is not None:
                rub = dx * (friction.seen[i, 0] - motion[j, 0])
                rub += dy * (friction.seen[i, 1] - motion[j, 1])
                rub += dz * (friction.seen[i, 2] - motion[j, 2])
                rub *= friction.strength * fluid.grip * slope * per_r2 * per_both
                fx += rub * dx
                fy += rub * dy
                fz += rub * dz
            elif friction is not None:
                shear = fluid.grip * slope * (r2 * per_r2 * per_both)
                fx += friction.strength * shear * (friction.seen[i, 0] - motion[j, 0])
                fy += friction.strength * shear * (friction.seen[i, 1] - motion[j, 1])
                fz += friction.strength * shear * (friction.seen[i, 2] - motion[j, 2])
        force[s, 0] = fluid.mass * fluid.mass * fx
        force[s, 1] = fluid.mass * fluid.mass * fy
        force[s, 2] = fluid.mass * fluid.mass * fz


# Not `fastmath`: that would take every number for finite, and this loop finds those that are not.
@njit(**EXACT)
def advance(
    first: int, last: int, split: int, dt: float, ahead: float, furthest: float, fluid: Fluid,
    rate: Array, reference: Array, place: Array, motion: Array, before: Array,
) -> tuple[float, int]:  # fmt: skip
    """Advance rows [first, last); return the greatest shift² since the list, and failures."""
    moved, failed = 0.0, 0
    for i in range(first, last):
        growth = rate[i, 3] + ahead * (rate[i, 3] - before[i])
        before[i] = rate[i, 3]
        density = place[i, 3] + dt * growth
        if i < split:
            step2, moved2 = 0.0, 0.0
            for d in range(3):
                step = dt * (motion[i, d] + 0.5 * dt * rate[i, d])
                place[i, d] += step
                motion[i, d] += dt * rate[i, d]
                step2 += step * step
                moved2 += (place[i, d] - reference[i, d]) ** 2
            moved = max(moved, moved2)
            failed += int(not (step2 <= furthest * furthest and 0.0 < density < math.inf))
        else:
            density = max(density, fluid.density)
        place[i, 3] = density
        motion[i, 3] = pressure_term(density, fluid)
    return moved, failed


@njit(**FAST)
def shift(first: int, last: int, time: float, drift: Array, place: Array) -> None:
    """Move rows [first, last) with velocities (fluid, 3) m/s for a time [s]."""
    for i in range(first, last):
        for d in range(3):
            place[i, d] += time * drift[i, d]


@njit(**EXACT)
def press(fluid: Fluid, place: Array, motion: Array) -> None:
    """Write p/ρ² of all rows from their densities."""
    for i in range(place.shape[0]):
        motion[i, 3] = pressure_term(place[i, 3], fluid)
