"""Motion over a step: velocity Verlet, with places and velocities in its middle."""

from numba import njit

from quintet.components.shared.numba_options import EXACT
from quintet.components.sph_solid.state import Array, Whole


@njit(**EXACT)
def kick_and_drift_half(
    first: int, last: int, dt: float, position: Array, velocity: Array, acceleration: Array,
    failed: Array, volume: Array, reference: Array, place: Array, motion: Array,
) -> tuple[float, float, float, float, float, float]:  # fmt: skip
    """Bring velocities and places to the middle of a step.

    Parameters
    ----------
    first, last : int
    dt : float, s
    position, velocity, acceleration : (n, 3) float arrays
        The velocity is changed.
    failed, volume : (n,) float arrays
    reference : (n, 3) float array, m
    place, motion : (n + images, 4) float arrays
        Written.

    Returns
    -------
    six floats, m : least x, y, z and greatest that particles will be from their references
    """
    half, big = 0.5 * dt, 1e300
    lx, ly, lz, hx, hy, hz = big, big, big, -big, -big, -big
    for i in range(first, last):
        u = velocity[i, 0] + half * acceleration[i, 0]
        v = velocity[i, 1] + half * acceleration[i, 1]
        w = velocity[i, 2] + half * acceleration[i, 2]
        velocity[i, 0], velocity[i, 1], velocity[i, 2] = u, v, w
        motion[i, 0], motion[i, 1], motion[i, 2], motion[i, 3] = u, v, w, failed[i]
        x, y, z = position[i, 0], position[i, 1], position[i, 2]
        place[i, 0], place[i, 1], place[i, 2] = x + half * u, y + half * v, z + half * w
        place[i, 3] = volume[i]
        dx = x + dt * u - reference[i, 0]
        dy = y + dt * v - reference[i, 1]
        dz = z + dt * w - reference[i, 2]
        lx, ly, lz = min(lx, dx), min(ly, dy), min(lz, dz)
        hx, hy, hz = max(hx, dx), max(hy, dy), max(hz, dz)
    return lx, ly, lz, hx, hy, hz


@njit(**EXACT)
def drift_half(
    first: int, last: int, dt: float, position: Array, velocity: Array, acceleration: Array,
    sound: Array, place: Array, motion: Array,
) -> None:  # fmt: skip
    """Bring places to the step's end, with velocities as the last acceleration predicts them."""
    half = 0.5 * dt
    for i in range(first, last):
        for d in range(3):
            x = position[i, d] + dt * velocity[i, d]
            position[i, d] = x
            place[i, d] = x
            motion[i, d] = velocity[i, d] + half * acceleration[i, d]
        motion[i, 3] = sound[i]


@njit(inline="always")
def meets(apart, before, support, skin):  # type: ignore[no-untyped-def]
    """Whether two are within the support that came nearer or went apart by more than the skin.

    Parameters
    ----------
    apart, before : three floats, m
        From one to the other, now and where they were listed.
    support, skin : float, m
    """
    x, y, z = apart
    dx, dy, dz = x - before[0], y - before[1], z - before[2]
    is_near = x * x + y * y + z * z < support * support
    return is_near and dx * dx + dy * dy + dz * dz > skin * skin


@njit(**EXACT)
def meets_unlisted(
    fast: Whole, middle: Array, end: Array, reference: Array, support: float, skin: float
) -> bool:
    """Whether a particle meets one that may be missing in its list.

    Parameters
    ----------
    fast : (k,) int array
        Particles that have gone further than half the skin.
    middle, end : (n, 3 or more) float arrays, m
        Places in the step's middle and at its end.
    reference : (n, 3) float array, m
    support, skin : float, m
    """
    for q in range(fast.shape[0]):
        i = fast[q]
        for places in (middle, end):
            for j in range(reference.shape[0]):
                apart = (
                    places[i, 0] - places[j, 0], places[i, 1] - places[j, 1],
                    places[i, 2] - places[j, 2],
                )  # fmt: skip
                before = (
                    reference[i, 0] - reference[j, 0], reference[i, 1] - reference[j, 1],
                    reference[i, 2] - reference[j, 2],
                )  # fmt: skip
                if meets(apart, before, support, skin):
                    return True
    return False


@njit(**EXACT)
def kick_and_heat(
    first: int, last: int, dt: float, velocity: Array, acceleration: Array, heating: Array,
    energy: Array,
) -> float:  # fmt: skip
    """Bring velocities to the step's end, and energies half a step on; return Σ v² [m2/s2].

    It is finite if all is well.
    """
    half, squares = 0.5 * dt, 0.0
    for i in range(first, last):
        energy[i] += half * heating[i]
        for d in range(3):
            v = velocity[i, d] + half * acceleration[i, d]
            velocity[i, d] = v
            squares += v * v
    return squares
