"""Laws of flags, and of items that are inactive."""

import numpy as np

from quintet.coupler.conform.trial import Trial, port_of
from quintet.coupler.conform.verdict import DoesNotApply, LawBroken, require, require_same_bits
from quintet.interfaces.component import Array, Component, Fields
from quintet.interfaces.ports import ACTIVE

FAR = 1e3  # of its scale, by which what comes in for inactive items is moved
STEPS = 5  # in which something may die


def flags_are_zero_or_one(trial: Trial) -> None:
    """And what is inactive stays so."""
    flags = [key for key, field in trial.outputs.items() if field.kind == "flag"]
    if not flags:
        raise DoesNotApply("it gives no flag")
    component = trial.build()
    last: Fields = {}
    for fields in [trial.give(component), *trial.move(component, STEPS)]:
        for key in flags:
            wrong = fields[key][~np.isin(fields[key], (0.0, 1.0))]
            require(
                not len(wrong),
                f"give: a flag must be 0 or 1; {key} has {wrong[:1]}. Correct it.",
            )
            back = (last[key] == 0.0) & (fields[key] == 1.0) if key in last else np.zeros(0)
            require(
                not (key in _activities(trial) and back.any()),
                f"give: what is inactive must stay so; an item of {key} came back. Keep it at 0.",
            )
        last = fields


def outputs_of_inactive_items_are_zero(trial: Trial) -> None:
    """No impulse comes from what is no longer there."""
    any_dead = False
    for key in _activities(trial):
        component, active = _live(trial, key)
        outputs, dead = trial.give(component), np.flatnonzero(active == 0.0)
        for output in trial.impulses:
            if not _is_about(trial, key, output):
                continue
            any_dead = any_dead or bool(len(dead))
            rows = np.abs(outputs[output][dead]).reshape(len(dead), -1).max(axis=1, initial=0.0)
            if rows.any():
                raise LawBroken(
                    f"give: impulses of inactive items must be zero; {output} of item "
                    f"{dead[int(np.argmax(rows))]}, which is inactive by {key}, is "
                    f"{rows.max():.3g}. Set it to zero."
                )
    if not any_dead:
        raise DoesNotApply("no item of it is inactive, or it gives no impulse on such items")


def inputs_of_inactive_items_change_nothing(trial: Trial) -> None:
    """Whatever comes in for what is no longer there is not looked at."""
    any_dead = False
    for key in _activities(trial):
        component, active = _live(trial, key)
        inputs = trial.inputs()
        about = [name for name in inputs if _is_about(trial, key, name)]
        if not about or active.all():
            continue
        any_dead = True
        other, _ = _live(trial, key, about)
        require_same_bits(
            _without_signs_of_zero(trial.give(other)),
            _without_signs_of_zero(trial.give(component)),
            f"take: inputs of items that are inactive by {key} must change nothing",
            "Leave out items whose active is 0.",
        )
    if not any_dead:
        raise DoesNotApply("no item of it is inactive, or it takes nothing for such items")


def _without_signs_of_zero(fields: Fields) -> Fields:
    """A zero that comes from times zero has the sign of what it was."""
    return {key: array + 0.0 for key, array in fields.items()}


def _activities(trial: Trial) -> list[str]:
    """Fields that say which items are active: those taken by the case, and those given."""
    known = {**{k: v for k, v in trial.inputs_known.items() if k in trial.case.rest}}
    known |= trial.outputs
    return [k for k, field in known.items() if field.name == ACTIVE.name and field.kind == "flag"]


def _is_about(trial: Trial, key: str, name: str) -> bool:
    """Whether a field is about the items whose activity another one says."""
    return name != key and port_of(name) in {port_of(key), *trial.case.activity.get(key, ())}


def _live(trial: Trial, key: str, spoilt: list[str] | None = None) -> tuple[Component, Array]:
    """Move a component some of whose items are inactive; spoil inputs of these, if asked to."""
    component, random = trial.build(), np.random.default_rng(3)
    if key in trial.outputs:
        trial.move(component, STEPS)
        active = np.array(component.give(frozenset({key}))[key])
    else:  # the first half of the items is dead
        count = len(trial.case.rest[key])
        active = (np.arange(count) >= (count + 1) // 2).astype(np.float64)
    for number in range(STEPS + 1, STEPS + 4):
        fields = dict(trial.inputs(number))
        if key in fields:
            fields[key] = active
        for name in spoilt or ():
            scale = FAR * max(float(np.max(trial.case.scale.get(name, 0.0))), 1.0)
            dead = (active == 0.0).reshape(-1, *([1] * (fields[name].ndim - 1)))
            fields[name] = np.where(
                dead, trial.moved(name, fields[name], scale, random), fields[name]
            )
        component.take(trial.received(fields))
        component.step(trial.case.dt)
    return component, active
