"""Material of a block of quadrature points over a step: from velocity gradients to stresses.

Each stage is a loop over lanes without branches, of which the compiler makes vectors; what few
points need, as the return to the flow stress that has not converged, is done one by one.
"""

import math

from numba import njit

from quintet.components.fe_plate.kernels.blocks import (
    ACTIVE,
    CHANGE,
    DAMAGE,
    DELTA,
    DEVIATOR,
    EDGE,
    ENERGY,
    GRADIENT,
    INLINED,
    LANES,
    LENGTH,
    OLD,
    PRESSURE,
    RATIO,
    SCRATCH,
    SOFT,
    SPECIFIC,
    SPEED,
    STRAIN,
    STRESS,
    TEMPERATURE,
    TRIAL,
    VISCOUS,
    WORK,
    greatest,
    least,
    nine,
    put_six,
    six,
)
from quintet.components.shared.elementary import exponential, logarithm
from quintet.components.shared.materials.equation_of_state import (
    pressure_and_energy,
    sound_speed_squared,
    temperature,
)
from quintet.components.shared.materials.fracture import damage_growth, is_torn
from quintet.components.shared.materials.strength import (
    equivalent,
    flow_stress,
    plastic_increment,
    softening,
    turned_and_strained,
)

HUGE = 1e300  # these kernels take every number to be finite
MOST = 12  # iterations of all lanes together
CLOSE = 1e-3  # last change of ln Δ; what is left is half its square
SMALL = 0.3  # least of the greatest plastic strain that is taken for a guess
STRIDE = 0.7  # greatest change of ln Δ


@njit(**INLINED)
def advance_material(points, base, work, law, resistance, dt):  # type: ignore[no-untyped-def]
    """Advance a block of points, whose state begins at `base`; return the least stable step [s].

    From gradients, volume ratios and lengths; writes stresses, and the speed of sound.
    """
    if dt > 0.0:
        strain_elastically(points, base, work, law, dt)
        if return_to_flow_stress(points, base, work, law, dt):
            yield_plastically(points, base, work, law, dt)
        press(points, base, work, law, dt)
    else:
        take_stresses(points, base, work)
    fracture(points, base, work, law)
    return resist(points, base, work, law, resistance, dt)


@njit(**INLINED)
def strain_elastically(points, base, work, law, dt):  # type: ignore[no-untyped-def]
    """Write trial deviators and their equivalent stresses; advance the temperature's softening."""
    for k in range(LANES):
        gradient = nine(work, GRADIENT, k)
        at = base + DEVIATOR * LANES + k
        before = six(points, at)
        put_six(work, OLD * LANES + k, before)
        s = turned_and_strained(before, gradient, law.shear, dt)
        put_six(work, STRESS * LANES + k, s)
        work[TRIAL * LANES + k] = equivalent(s)
        work[DELTA * LANES + k] = 0.0
        work[WORK * LANES + k] = 0.0


@njit(**INLINED)
def return_to_flow_stress(points, base, work, law, dt):  # type: ignore[no-untyped-def]
    """Write plastic strains of the step; whether any point yields.

    Newton's method on g = se - 3GΔ - Y(ε + Δ, Δ/dt), all lanes at once. In ln Δ g is concave and
    falls, by hardening and by the rate: from below it passes the root once, and comes down to it.
    """
    if law.hard >= HUGE:
        return False
    if law.m >= 1.0:  # most points have less than the initial yield stress, as T*ᵐ ≤ T*
        for k in range(LANES):
            warm = points[base + TEMPERATURE * LANES + k] - law.reference_temperature
            weak = law.hard * (1.0 - max(warm / law.melting, 0.0))
            work[SCRATCH * LANES + k] = work[TRIAL * LANES + k] - weak
        if greatest(work, SCRATCH) <= 0.0:
            return False
    stiff = 3.0 * law.shear
    for k in range(LANES):
        strain = points[base + STRAIN * LANES + k]
        soft = softening(points[base + TEMPERATURE * LANES + k], law)
        work[SOFT * LANES + k] = soft
        trial = work[TRIAL * LANES + k]
        # Most of the strain is plastic where it is large: at that rate the root is close.
        rate = strain_rate(nine(work, GRADIENT, k))
        moving, hardens, _ = flow_stress(strain, rate, soft, law)
        still = moving / (1.0 + law.c * logarithm(max(rate / law.reference_rate, 1.0)))
        close = (trial - moving) / (stiff + hardens)
        above = max(trial - still, 0.0) / stiff
        # Where it is small the rate takes up what the trial stress has beyond the flow stress.
        beyond = (trial / max(still, 1.0) - 1.0) / max(law.c, 1e-9)
        above = min(above, dt * law.reference_rate * exponential(beyond))
        work[DELTA * LANES + k] = close if close > SMALL * above else above
    if greatest(work, DELTA) <= 0.0:
        return False
    for _ in range(MOST):
        for k in range(LANES):
            trial, delta = work[TRIAL * LANES + k], work[DELTA * LANES + k]
            strain, soft = points[base + STRAIN * LANES + k], work[SOFT * LANES + k]
            stress, hardens, hastens = flow_stress(strain + delta, delta / dt, soft, law)
            slope = delta * (stiff + hardens + hastens / dt)
            gap = trial - stiff * delta - stress
            moved = min(gap / slope, STRIDE) if delta > 0.0 else 0.0
            work[SCRATCH * LANES + k] = abs(moved)
            work[DELTA * LANES + k] = delta * exponential(moved)
        if greatest(work, SCRATCH) <= CLOSE:
            return True
    for k in range(LANES):
        work[DELTA * LANES + k] = plastic_increment(
            work[TRIAL * LANES + k],
            points[base + STRAIN * LANES + k],
            work[SOFT * LANES + k],
            dt,
            law,
        )
    return True


@njit(**INLINED)
def strain_rate(gradient):  # type: ignore[no-untyped-def]
    """Equivalent rate √(2/3 D':D') [1/s] of the deviator of a velocity gradient."""
    l00, l01, l02, l10, l11, l12, l20, l21, l22 = gradient
    trace, xy, yz, zx = l00 + l11 + l22, l01 + l10, l12 + l21, l20 + l02
    squares = l00 * l00 + l11 * l11 + l22 * l22 - trace * trace / 3.0
    return math.sqrt(max(2.0 / 3.0 * squares + (xy * xy + yz * yz + zx * zx) / 3.0, 0.0))


@njit(**INLINED)
def yield_plastically(points, base, work, law, dt):  # type: ignore[no-untyped-def]
    """Scale the deviators back, advance plastic strains, and write the plastic work [J/m3]."""
    for k in range(LANES):
        trial, delta = work[TRIAL * LANES + k], work[DELTA * LANES + k]
        scale = 1.0 - 3.0 * law.shear * delta / max(trial, 1.0)
        xx, yy, zz, xy, yz, zx = six(work, STRESS * LANES + k)
        s = scale * xx, scale * yy, scale * zz, scale * xy, scale * yz, scale * zx
        put_six(work, STRESS * LANES + k, s)
        more = delta if points[base + ACTIVE * LANES + k] > 0.0 else 0.0
        points[base + STRAIN * LANES + k] += more
        work[WORK * LANES + k] = scale * trial * delta


@njit(**INLINED)
def press(points, base, work, law, dt):  # type: ignore[no-untyped-def]
    """Advance pressures, energies and temperatures, and the deviators of points that bear any."""
    for k in range(LANES):
        gradient = nine(work, GRADIENT, k)
        divergence = gradient[0] + gradient[4] + gradient[8]
        ratio = work[RATIO * LANES + k]
        per_density = work[SPECIFIC * LANES + k]
        change = divergence * dt * per_density
        live = points[base + ACTIVE * LANES + k] > 0.0
        s = six(work, STRESS * LANES + k)
        power = deviatoric_power(six(work, OLD * LANES + k), s, gradient)
        old = points[base + ENERGY * LANES + k]
        energy = old + 0.5 * dt * per_density * power
        viscous = points[base + VISCOUS * LANES + k]
        energy -= 0.5 * (points[base + PRESSURE * LANES + k] + viscous) * change
        pressure, energy = pressure_and_energy(1.0 / ratio - 1.0, energy, change, law)
        points[base + PRESSURE * LANES + k] = pressure if live else 0.0
        points[base + ENERGY * LANES + k] = energy if live else old
        at = base + DEVIATOR * LANES + k
        points[at] = s[0] if live else 0.0
        points[at + LANES] = s[1] if live else 0.0
        points[at + 2 * LANES] = s[2] if live else 0.0
        points[at + 3 * LANES] = s[3] if live else 0.0
        points[at + 4 * LANES] = s[4] if live else 0.0
        points[at + 5 * LANES] = s[5] if live else 0.0
        work[CHANGE * LANES + k] = change
    heat(points, base, work, law)
    if law.d1 == 0.0 and law.d2 == 0.0:
        return
    for k in range(LANES):
        delta = work[DELTA * LANES + k]
        if delta > 0.0 and points[base + ACTIVE * LANES + k] > 0.0:
            points[base + DAMAGE * LANES + k] += damage_growth(
                six(points, base + DEVIATOR * LANES + k),
                points[base + PRESSURE * LANES + k],
                delta,
                points[base + TEMPERATURE * LANES + k],
                dt,
                law,
            )


@njit(**INLINED)
def heat(points, base, work, law):  # type: ignore[no-untyped-def]
    """Advance temperatures: by the energy of shocked materials, by the plastic work of others."""
    for k in range(LANES):
        at = base + TEMPERATURE * LANES + k
        live = points[base + ACTIVE * LANES + k] > 0.0
        warm = points[at] + law.heating * work[WORK * LANES + k]
        if law.shocks:
            warm = temperature(
                1.0 / work[RATIO * LANES + k] - 1.0, points[base + ENERGY * LANES + k], law
            )
        points[at] = warm if live else points[at]


@njit(**INLINED)
def take_stresses(points, base, work):  # type: ignore[no-untyped-def]
    """Take the stresses as they are, for a step of none."""
    for k in range(LANES):
        work[CHANGE * LANES + k] = 0.0


@njit(**INLINED)
def fracture(points, base, work, law):  # type: ignore[no-untyped-def]
    """Let points fail by strain, damage or the greatest principal stress: they bear no more."""
    for k in range(LANES):
        at = base + k
        mises = equivalent(six(points, at + DEVIATOR * LANES))
        # The greatest principal stress is at most 2/3 of the equivalent one above the mean.
        torn = 2.0 / 3.0 * mises - points[at + PRESSURE * LANES] - law.spall
        strained = points[at + STRAIN * LANES] - law.failure_strain
        damaged = points[at + DAMAGE * LANES] - 1.0
        work[SCRATCH * LANES + k] = max(torn, max(strained, damaged))
    if greatest(work, SCRATCH) < 0.0:
        return
    for k in range(LANES):
        at = base + k
        s, pressure = six(points, at + DEVIATOR * LANES), points[at + PRESSURE * LANES]
        failed = points[at + STRAIN * LANES] >= law.failure_strain
        failed = failed or points[at + DAMAGE * LANES] >= 1.0
        if failed or is_torn(s, pressure, law.spall):
            points[at + ACTIVE * LANES] = 0.0
            points[at + PRESSURE * LANES] = 0.0
            put_six(points, at + DEVIATOR * LANES, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0))


@njit(**INLINED)
def resist(points, base, work, law, resistance, dt):  # type: ignore[no-untyped-def]
    """Write stresses with those of bulk viscosity and damping; return the least stable step [s]."""
    linear, quadratic, damp = resistance.linear, resistance.quadratic, resistance.damping
    for k in range(LANES):
        at = base + k
        l00, l01, l02, l10, l11, l12, l20, l21, l22 = nine(work, GRADIENT, k)
        divergence = l00 + l11 + l22
        ratio, length = work[RATIO * LANES + k], work[LENGTH * LANES + k]
        pressure, old = points[at + PRESSURE * LANES], points[at + ENERGY * LANES]
        live = points[at + ACTIVE * LANES] > 0.0
        sound = math.sqrt(sound_speed_squared(1.0 / ratio - 1.0, old, pressure, law))
        edge, rate = work[EDGE * LANES + k], max(0.0, -divergence)
        drag = (linear * sound + quadratic * quadratic * edge * rate) if rate > 0.0 else 0.0  # m/s
        per_density = work[SPECIFIC * LANES + k]
        viscous = edge * rate * drag / per_density if live else 0.0
        energy = old - 0.5 * viscous * work[CHANGE * LANES + k]
        slower = drag + damp * sound * sound / length
        trace, double = -pressure - viscous, 0.0
        if damp > 0.0:
            gradient = l00, l01, l02, l10, l11, l12, l20, l21, l22
            energy += dt * per_density * damp * damping_power(gradient, law)
            double = 2.0 * damp * law.shear
            trace += damp * (law.bulk - 2.0 / 3.0 * law.shear) * divergence
        points[at + VISCOUS * LANES] = viscous
        points[at + ENERGY * LANES] = energy if live else old
        xx, yy, zz, xy, yz, zx = six(points, at + DEVIATOR * LANES)
        row = STRESS * LANES + k
        work[row] = xx + trace + double * l00 if live else 0.0
        work[row + LANES] = yy + trace + double * l11 if live else 0.0
        work[row + 2 * LANES] = zz + trace + double * l22 if live else 0.0
        work[row + 3 * LANES] = xy + 0.5 * double * (l01 + l10) if live else 0.0
        work[row + 4 * LANES] = yz + 0.5 * double * (l12 + l21) if live else 0.0
        work[row + 5 * LANES] = zx + 0.5 * double * (l20 + l02) if live else 0.0
        work[SPEED * LANES + k] = sound
        step = length / (slower + math.sqrt(slower * slower + sound * sound))
        work[SCRATCH * LANES + k] = step if live else HUGE
    return least(work, SCRATCH)


@njit(**INLINED)
def deviatoric_power(before, after, gradient):  # type: ignore[no-untyped-def]
    """(s + s'):D [W/m3], of the deviators at the step's ends."""
    l00, l01, l02, l10, l11, l12, l20, l21, l22 = gradient
    return (
        (before[0] + after[0]) * l00
        + (before[1] + after[1]) * l11
        + (before[2] + after[2]) * l22
        + (before[3] + after[3]) * (l01 + l10)
        + (before[4] + after[4]) * (l12 + l21)
        + (before[5] + after[5]) * (l20 + l02)
    )


@njit(**INLINED)
def damping_power(gradient, law):  # type: ignore[no-untyped-def]
    """2G dev D:D + K (tr D)² [Pa/s2] of a velocity gradient."""
    l00, l01, l02, l10, l11, l12, l20, l21, l22 = gradient
    trace, xy, yz, zx = l00 + l11 + l22, l01 + l10, l12 + l21, l20 + l02
    squares = l00 * l00 + l11 * l11 + l22 * l22 - trace * trace / 3.0
    squares += 0.5 * (xy * xy + yz * yz + zx * zx)
    return 2.0 * law.shear * squares + law.bulk * trace * trace
