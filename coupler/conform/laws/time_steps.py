"""Laws of steps: how long they may be, and that they add up."""

import math

import numpy as np

from quintet.coupler.conform.trial import Trial
from quintet.coupler.conform.verdict import (
    DoesNotApply,
    LawBroken,
    compare_gaps,
    raised,
    require,
    require_same_bits,
)
from quintet.interfaces.component import Array

MANY = 10  # steps of the largest stable size


def the_stable_step_is_positive(trial: Trial) -> None:
    """At the start and after steps; asked twice it is the same, and asking changes nothing."""
    component, unasked = trial.build(), trial.build()
    for number in range(4):
        step, repeated = (float(component.stable_dt()) for _ in range(2))
        require(
            step > 0.0,  # untrue of nan
            f"stable_dt: it must be above 0 s; found {step} after {number} step(s). Look at the "
            "state that it is computed from.",
        )
        require(
            step == repeated,
            f"stable_dt: asked twice it must be the same; found {step!r} and {repeated!r} after "
            f"{number} step(s). Compute it from the state alone.",
        )
        trial.move(component, 1, first=number + 1)
        trial.move(unasked, 1, first=number + 1)
    require_same_bits(
        component.save(),
        unasked.save(),
        "stable_dt: asking for it must change nothing",
        "Compute it from the state, and do not change that.",
    )


def the_stable_step_is_the_same_after_load(trial: Trial) -> None:
    """As windows that are repeated, and runs that are resumed, have the same steps."""
    component = trial.build()
    trial.move(component)
    saved, expected = trial.received(component.save()), float(component.stable_dt())
    trial.move(component, first=9)
    for label, other in (("the same", component), ("another", trial.build())):
        other.load(saved)
        step = float(other.stable_dt())
        require(
            step == expected,
            f"stable_dt: after load it must be what it was when the state was saved, {expected!r}; "
            f"found {step!r} in {label} component. Save what it is computed from.",
        )


def stable_steps_stay_finite(trial: Trial) -> None:
    """Some steps, each of the largest size that it allows."""
    if not trial.case.any_time:
        raise DoesNotApply("its case says that it gives at certain times only")
    component = trial.build()
    for number in range(MANY):
        allowed = float(component.stable_dt())
        dt = allowed if math.isfinite(allowed) else trial.case.dt
        component.take(trial.inputs(1))
        try:
            component.step(dt)
        except Exception as error:
            raise LawBroken(
                f"step: steps of the size that stable_dt allows must succeed; step {number + 1} of "
                f"{dt:.6g} s failed with {raised(error)}. Allow shorter ones."
            ) from error
        for key, array in component.give(frozenset(trial.outputs)).items():
            require(
                bool(np.isfinite(array).all()),
                f"step: steps of the size that stable_dt allows must stay finite; {key} is not "
                f"after step {number + 1} of {dt:.6g} s. Allow shorter ones.",
            )


def two_half_steps_come_to_one(trial: Trial) -> None:
    """They differ by the step's square: a half as long, a quarter as far apart."""
    case = trial.case
    if not case.smooth:
        raise DoesNotApply("its case says that its answer is not smooth in time")
    if not trial.outputs:
        raise DoesNotApply("it gives nothing")
    rule = "step: two half steps and a whole one must be"
    remedy = "Advance by exactly the dt that is given."
    if case.any_time:
        compare_gaps(lambda dt: _gap(trial, dt), case.dt, rule, remedy)
        return
    for key, gap in _gap(trial, case.dt).items():
        require(gap == 0.0, f"{rule} the same bits; found {key} apart by {gap:.3g}. {remedy}")


def _gap(trial: Trial, dt: float) -> dict[str, float]:
    """Difference of one step and two half ones, for instants and for impulses."""
    ends, sums = [], []
    for pieces in (1, 2):
        component = trial.build()
        component.take(trial.inputs(1))
        total: dict[str, Array] = {}
        for piece in range(pieces):
            component.step(dt / pieces)
            if trial.case.any_time or piece + 1 == pieces:
                outputs = trial.give(component)
            if trial.case.any_time:
                parts = {key: dt / pieces * outputs[key] for key in trial.impulses}
                total = {key: total.get(key, 0.0) + part for key, part in parts.items()}
        ends.append(outputs)
        sums.append(total)
    gaps = {}
    for key in trial.outputs:
        summed = key in trial.impulses and trial.case.any_time
        whole, halves = sums if summed else ends
        # The scale must not change with dt: that of an impulse is its mean rate.
        largest = float(np.abs(whole[key]).max(initial=0.0)) / (dt if summed else 1.0)
        gap = float(np.abs(whole[key] - halves[key]).max(initial=0.0))
        gaps[key] = gap / max(1.0, largest)
    return gaps
