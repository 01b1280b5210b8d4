"""Laws of what a component gives."""

import numpy as np

from quintet.coupler.conform.trial import Trial, copies, port_of
from quintet.coupler.conform.verdict import (
    DoesNotApply,
    LawBroken,
    compare_gaps,
    require,
    require_same_bits,
)
from quintet.interfaces import rotation
from quintet.interfaces.component import Array, Component, Fields

UNIT = 1e-9  # by which the length of a quaternion may be off one


def outputs_match_their_ports(trial: Trial) -> None:
    """In name, shape and type, finite, and with one row per item of the port; at any time."""
    component = trial.build()
    for fields in (trial.give(component), *trial.move(component)):
        require(
            fields.keys() == trial.outputs.keys(),
            f"give: what is asked for is {', '.join(trial.outputs) or 'nothing'}; found "
            f"{', '.join(fields) or 'nothing'}. Correct give, or the ports.",
        )
        rows: dict[str, int] = {}
        for key, array in fields.items():
            shape = trial.outputs[key].shape
            require(
                array.ndim == len(shape) + 1 and array.shape[1:] == shape,
                f"give: {key} must have shape (n, {', '.join(map(str, shape))}) as its port says; "
                f"found {array.shape}. Correct give, or the port.",
            )
            require(
                array.dtype == np.float64,
                f"give: {key} must be float64; found {array.dtype}. Convert it.",
            )
            require(
                bool(np.isfinite(array).all()),
                f"give: {key} must be finite; found {array[~np.isfinite(array)][:1]}. Look at its "
                "state, or make the case's dt smaller.",
            )
            first = rows.setdefault(port_of(key), len(array))
            require(
                len(array) == first,
                f"give: all fields of a port must have one row per item; {key} has {len(array)} "
                f"rows, others {first}. Correct give.",
            )


def just_what_is_wanted_is_given(trial: Trial) -> None:
    """No output is missing, and none is computed that nobody reads."""
    component = trial.build()
    for _ in range(2):  # at the start, and after a step
        for wanted in _choices(trial):
            outputs = component.give(wanted)
            missing, more = wanted - outputs.keys(), outputs.keys() - wanted
            require(
                not missing,
                f"give: every output that is wanted must be given; {', '.join(sorted(missing))} is "
                f"missing where {', '.join(sorted(wanted))} was wanted. Give it.",
            )
            require(
                not more,
                f"give: only what is wanted may be given ({', '.join(sorted(wanted)) or 'nothing'})"
                f"; found {', '.join(sorted(more))} too. Return {{key: ... for key in wanted}}.",
            )
        trial.move(component, 1)


def what_else_is_wanted_changes_no_bit(trial: Trial) -> None:
    """Each output, and the impulses alone, are the same bits as when all are asked for."""
    if not trial.outputs:
        raise DoesNotApply("it gives nothing")
    component, silent = trial.build(), trial.build()
    trial.move(component)
    trial.move(silent, wanted=frozenset())
    everything = trial.give(component)
    for wanted in _choices(trial):
        outputs = {key: array for key, array in component.give(wanted).items() if key in wanted}
        expected = {key: everything[key] for key in wanted}
        rule = f"give: asked for {', '.join(sorted(wanted)) or 'nothing'} alone it must be the same"
        require_same_bits(
            outputs, expected, rule, "Let no output depend on what else is asked for."
        )
    require_same_bits(
        trial.give(silent),
        everything,
        "give: being asked must change nothing",
        "Compute outputs from the state; do not change it in give.",
    )


def _choices(trial: Trial) -> list[frozenset[str]]:
    """Nothing, each output alone, the impulses, and all."""
    sets = [frozenset[str](), *(frozenset({key}) for key in trial.outputs), trial.impulses]
    return list(dict.fromkeys([*sets, frozenset(trial.outputs)]))


def the_number_of_items_never_changes(trial: Trial) -> None:
    """What dies becomes inactive; its row stays."""
    component = trial.build()
    first = trial.give(component)
    for number, fields in enumerate(trial.move(component, 5), 1):
        for key, array in fields.items():
            require(
                len(array) == len(first[key]),
                f"give: items of a port must stay as many as they are; {key} has {len(array)} rows "
                f"after step {number} and had {len(first[key])}. Give items that die as inactive.",
            )


def outputs_are_copies(trial: Trial) -> None:
    """Neither what the component does later nor what a reader does to them changes the other."""
    component, other = trial.build(), trial.build()
    trial.move(component)
    trial.move(other)
    for name, arrays in _outgoing(component, trial).items():
        unwritten = copies(arrays)
        for array in arrays.values():
            if array.flags.writeable:
                array[...] = -7 if array.dtype.kind in "iu" else np.nan
        require_same_bits(
            _outgoing(component, trial)[name],
            unwritten,
            f"{name}: arrays that go out must be copies, so that writing to them changes nothing",
            "Return copies.",
        )
    before = _outgoing(component, trial)
    kept_all = {name: copies(arrays) for name, arrays in before.items()}
    after = trial.move(component, first=9)
    for name, arrays in before.items():
        require_same_bits(
            arrays,
            kept_all[name],
            f"{name}: arrays that went out must not change as the component goes on",
            "Return copies.",
        )
    require_same_bits(
        after[-1],
        trial.move(other, first=9)[-1],
        "give: writing to arrays that went out must not change what comes later",
        "Return copies.",
    )


def _outgoing(component: Component, trial: Trial) -> dict[str, Fields]:
    totals = component.totals()
    return {
        "give": component.give(frozenset(trial.outputs)),
        "describe": component.describe(),
        "view": component.view(),
        "totals": {"momentum": totals.momentum, "angular_momentum": totals.angular_momentum},
    }


def rotations_are_unit_quaternions(trial: Trial) -> None:
    """To rounding, however far they turn."""
    turning = [key for key, field in trial.outputs.items() if field.kind == "rotation"]
    if not turning:
        raise DoesNotApply("it gives no rotation")
    component = trial.build()
    for number, fields in enumerate([trial.give(component), *trial.move(component, 5)]):
        for key in turning:
            length = np.sqrt((fields[key] ** 2).sum(axis=1))
            worst = int(np.argmax(np.abs(length - 1.0)))
            require(
                bool(abs(length[worst] - 1.0) <= UNIT),
                f"give: a rotation must be a unit quaternion; {key} of item {worst} has length "
                f"{length[worst]:.12g} after {number} step(s). Normalise it in every step.",
            )


def values_follow_their_rates(trial: Trial) -> None:
    """In a step a value changes by its mean rate times the step; a rotation on the sphere."""
    rates = {
        key: f"{port_of(key)}.{field.rate}"
        for key, field in trial.outputs.items()
        if field.rate and field.centring == "instant"
    }
    if not rates:
        raise DoesNotApply("it gives no value with its rate")
    if not (trial.case.smooth and trial.case.any_time):
        raise DoesNotApply("its case says that it is not smooth, or gives at certain times only")

    def gap(dt: float) -> dict[str, float]:
        component = trial.build()
        trial.move(component)
        before = trial.give(component)
        component.take(trial.inputs(7))
        component.step(dt)
        after = trial.give(component)
        gaps = {}
        for key, rate in rates.items():
            expected = 0.5 * dt * (before[rate] + after[rate])
            turns = trial.outputs[key].kind == "rotation"
            change = _turn(before[key], after[key], expected) if turns else after[key] - before[key]
            size = max(1.0, float(np.abs(after[key]).max(initial=0.0)))
            gaps[key] = float(np.abs(change - expected).max(initial=0.0)) / size
        return gaps

    compare_gaps(
        gap,
        trial.case.dt,
        "give: a value's change and its mean rate times the step must be",
        "Give the rate of that value, at the same time.",
    )


def _turn(before: Array, after: Array, near: Array) -> Array:
    """Rotation vector between two quaternions; a quaternion and its negative are one rotation."""
    return rotation.vector_between(before, after, near)


def at_rest_nothing_comes_out(trial: Trial) -> None:
    """Under inputs at rest instants stay as they are, and impulses are zero."""
    if not trial.case.still:
        raise DoesNotApply("its case says that it moves by itself")
    component = trial.build()
    before = trial.give(component)
    for _ in range(3):
        component.take(trial.inputs())
        component.step(trial.case.dt)
    for key, array in trial.give(component).items():
        expected = np.zeros_like(array) if key in trial.impulses else before[key]
        off = np.abs(array - expected)
        if not (off <= 1e-14).all():
            rule = "zero" if key in trial.impulses else "as it was"
            raise LawBroken(
                f"give: where nothing comes in, {key} must be {rule}; it is off by "
                f"{float(off.max()):.3g}. Look for what drives it, or let the case say still=False."
            )
