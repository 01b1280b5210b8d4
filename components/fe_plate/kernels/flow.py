"""Return of a block of points to the flow stress: plastic strains of a step.

The root of g = se - 3GΔ - Y(ε + Δ, Δ/dt) is sought in y = ln Δ, in which g is concave and falls by
hardening and by the rate, with Halley's method: each iteration leaves about the cube of the change.
The first ones take logarithms and exponentials of few digits.
"""

from numba import njit

from quintet.components.fe_plate.kernels.blocks import (
    DELTA,
    GRADIENT,
    LOGARITHM,
    SCRATCH,
    SOFT,
    TRIAL,
    greatest,
    nine,
)
from quintet.components.fe_plate.laws import strain_rate
from quintet.components.fe_plate.state import LANES, STRAIN, TEMPERATURE
from quintet.components.shared.elementary import (
    exponential,
    exponential_of_few_digits,
    logarithm,
    logarithm_of_few_digits,
)
from quintet.components.shared.materials.strength import plastic_increment, softening
from quintet.components.shared.numba_options import FAST_LANEWISE

HUGE = 1e300  # these kernels take every number to be finite
ROUGH = 2  # iterations with few digits
MOST = 8  # iterations of all lanes together
CLOSE = 1e-2  # last change of ln Δ
SMALL = -1.2  # ln of the least of the greatest plastic strain that is taken for a guess
STRIDE = 2.0  # greatest change of ln Δ
LEAST = 1e-300  # plastic strain by which none is divided


@njit(**FAST_LANEWISE)
def return_to_flow_stress(points, work, law, dt):  # type: ignore[no-untyped-def]
    """Write plastic strains of the step; whether any point yields."""
    if law.hard >= HUGE:
        return False
    if law.m >= 1.0:  # most points have less than the initial yield stress, as T*ᵐ ≤ T*
        for k in range(LANES):
            warm = points[TEMPERATURE * LANES + k] - law.reference_temperature
            weak = law.hard * (1.0 - max(warm / law.melting, 0.0))
            work[SCRATCH * LANES + k] = work[TRIAL * LANES + k] - weak
        if greatest(work, SCRATCH) <= 0.0:
            return False
    slowest = logarithm(dt * law.reference_rate)  # ln Δ below which the rate has no part
    guess(points, work, law, slowest)
    if greatest(work, DELTA) <= 0.0:
        return False
    log, exp = logarithm_of_few_digits, exponential_of_few_digits
    for _ in range(ROUGH):
        improve(points, work, law, slowest, log, exp)
    for _ in range(MOST):
        improve(points, work, law, slowest, logarithm, exponential)
        if greatest(work, SCRATCH) <= CLOSE:
            return True
    for k in range(LANES):
        work[DELTA * LANES + k] = plastic_increment(
            work[TRIAL * LANES + k],
            points[STRAIN * LANES + k],
            work[SOFT * LANES + k],
            dt,
            law,
        )
    return True


@njit(**FAST_LANEWISE)
def guess(points, work, law, slowest):  # type: ignore[no-untyped-def]
    """Write softening, guesses of plastic strains, 0 of points that do not yield, and their ln."""
    stiff = 3.0 * law.shear
    for k in range(LANES):
        strain, trial = points[STRAIN * LANES + k], work[TRIAL * LANES + k]
        soft = softening(points[TEMPERATURE * LANES + k], law)
        work[SOFT * LANES + k] = soft
        raised = strain if law.n == 1.0 else exponential(law.n * logarithm(strain))
        grows = soft * law.b * raised if strain > 0.0 else 0.0
        still = law.hard * soft + grows
        # Most of the strain is plastic where it is large: at that rate the root is close.
        rate = strain_rate(nine(work, GRADIENT, k))
        faster = 1.0 + law.c * max(logarithm_of_few_digits(rate / law.reference_rate), 0.0)
        hardens = law.n * grows / max(strain, LEAST) * faster
        close = logarithm_of_few_digits((trial - still * faster) / (stiff + hardens))
        # Where it is small the rate takes up what the trial stress has beyond the flow stress.
        beyond = max(trial - still, 0.0)
        taken_up = slowest + beyond / max(still, 1.0) / max(law.c, 1e-9)
        above = min(logarithm_of_few_digits(beyond / stiff), taken_up)
        y = close if close > above + SMALL else above
        work[LOGARITHM * LANES + k] = y
        work[DELTA * LANES + k] = exponential_of_few_digits(y) if beyond > 0.0 else 0.0


@njit(**FAST_LANEWISE)
def improve(points, work, law, slowest, log, exp):  # type: ignore[no-untyped-def]
    """Change ln Δ of points that yield by a step of Halley's method; write how far."""
    stiff = 3.0 * law.shear
    for k in range(LANES):
        delta, y = work[DELTA * LANES + k], work[LOGARITHM * LANES + k]
        strain, soft = points[STRAIN * LANES + k] + delta, work[SOFT * LANES + k]
        raised = strain if law.n == 1.0 else exp(law.n * log(strain))
        grows = soft * law.b * raised
        static = law.hard * soft + grows
        faster = 1.0 + law.c * max(y - slowest, 0.0)
        hastens = static * law.c if y > slowest else 0.0
        share = delta / max(strain, LEAST)
        slope = law.n * share * grows  # of the static flow stress, in y
        gap = work[TRIAL * LANES + k] - stiff * delta - static * faster
        first = stiff * delta + slope * faster + hastens  # derivatives of -g in y
        second = stiff * delta + slope * (1.0 + (law.n - 1.0) * share) * faster
        second += 2.0 * slope * (law.c if y > slowest else 0.0)
        moved = gap * first / max(first * first + 0.5 * gap * second, LEAST)
        moved = min(max(moved, -STRIDE), STRIDE) if delta > 0.0 else 0.0
        work[SCRATCH * LANES + k] = abs(moved)
        work[LOGARITHM * LANES + k] = y + moved
        work[DELTA * LANES + k] = delta * exp(moved)
