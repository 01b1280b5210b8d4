"""Laws of state: all of it is saved, none of it is shared."""

from quintet.coupler.conform.trial import Trial, copies
from quintet.coupler.conform.verdict import require, require_same_bits
from quintet.interfaces.component import Component, Fields
from quintet.interfaces.lines.message import decode, encode

SAVE_ALL = "Save all that changes, and bring all of it back."


def the_same_inputs_give_the_same_bits(trial: Trial) -> None:
    """Two components made from the same parameters; randomness comes from a seed in these."""
    runs = [trial.move(trial.build()) for _ in range(2)]
    for number, (first_outputs, other) in enumerate(zip(*runs, strict=True), 1):
        require_same_bits(
            other,
            first_outputs,
            f"made twice from the same parameters it must give the same bits, step {number}",
            "Take randomness from a seed in the parameters.",
        )


def load_then_repeat_gives_the_same_bits(trial: Trial) -> None:
    """In the component that was saved, and in one that was just made."""
    component = trial.build()
    trial.move(component)
    saved = copies(component.save())
    first = trial.move(component, first=9)
    for label, other in (("the same", component), ("another", trial.build())):
        other.load(trial.received(saved))
        rule = f"load: {label} component must come back to what was saved"
        require_same_bits(other.save(), saved, rule, SAVE_ALL)
        repeated = trial.move(other, first=9)
        for number, (before, two) in enumerate(zip(first, repeated, strict=True), 1):
            rule = f"load: then repeated, {label} component must give the same bits, step {number}"
            require_same_bits(two, before, rule, SAVE_ALL)


def save_changes_nothing(trial: Trial) -> None:
    """A snapshot that is taken leaves no trace in what follows."""
    component, other = trial.build(), trial.build()
    trial.move(component)
    trial.move(other)
    component.save()
    require_same_bits(
        trial.move(component, first=9)[-1],
        trial.move(other, first=9)[-1],
        "save: it must change nothing in what comes later",
        "Copy the state, and do not change it.",
    )


def what_is_saved_crosses_a_line(trial: Trial) -> None:
    """Saved arrays are of types and shapes that messages know."""
    component = trial.build()
    trial.move(component)
    saved = copies(component.save())
    arrived = decode(bytes(encode({"order": "done"}, saved, None))).fields
    rule = "save: what is saved must come over a line as it was"
    require_same_bits(arrived, saved, rule, "Save arrays of numbers, no objects.")
    component.load(arrived)
    require_same_bits(component.save(), saved, "load: what came over a line must load", SAVE_ALL)


def what_is_saved_does_not_change_afterwards(trial: Trial) -> None:
    """It is kept while the component goes on."""
    component = trial.build()
    trial.move(component)
    saved = component.save()
    before = copies(saved)
    trial.move(component, first=9)
    rule = "save: what was saved must not change as the component goes on"
    require_same_bits(saved, before, rule, "Save copies.")


def what_is_loaded_is_neither_written_to_nor_kept(trial: Trial) -> None:
    """It may be loaded again, and its memory may be used for something else."""
    component = trial.build()
    trial.move(component)
    saved = copies(component.save())
    runs = []
    for spoils in (False, True):
        state = copies(saved)
        component.load(_views(state))
        require_same_bits(state, saved, "load: what is loaded must not be written to", "Copy it.")
        for array in state.values() if spoils else ():
            array[...] = 77
        runs.append(trial.move(component, first=9)[-1])
        if not spoils:
            rule = "load: what is loaded must not be written to as the component goes on"
            require_same_bits(state, saved, rule, "Copy it.")
    rule = "load: what is loaded must not be kept, as its memory is used again"
    require_same_bits(runs[1], runs[0], rule, "Keep copies: np.array(state[key]).")


def warnings_are_those_of_the_state(trial: Trial) -> None:
    """Warnings come back with the state to which they belong, and texts they are."""
    component, other = trial.build(), trial.build()
    early = dict(component.warnings()), trial.received(component.save())
    trial.move(component)
    late = dict(component.warnings()), trial.received(component.save())
    for warnings, state in (late, early):
        other.load(state)
        texts = [*warnings, *warnings.values()]
        require(
            all(isinstance(text, str) for text in texts),
            f"warnings: must be texts by subject; found {warnings!r}. Return a dict of texts.",
        )
        require(
            dict(other.warnings()) == warnings,
            f"warnings: after load they must be those of the saved state, {warnings!r}; found "
            f"{dict(other.warnings())!r}. Judge them from what is saved.",
        )
        trial.move(other)


def final_warnings_change_nothing(trial: Trial) -> None:
    """They are texts by subject, and the component goes on as if nobody had asked."""
    component, other = trial.build(), trial.build()
    trial.move(component)
    trial.move(other)
    warnings = dict(component.final_warnings())
    require(
        all(isinstance(text, str) for text in (*warnings, *warnings.values())),
        f"final_warnings: must be texts by subject; found {warnings!r}. Return a dict of texts.",
    )
    require_same_bits(
        component.save(),
        other.save(),
        "final_warnings: the state must stay as it is",
        "Judge what is there, and change nothing.",
    )


def _views(state: Fields) -> Fields:
    views = {key: array.view() for key, array in state.items()}
    for view in views.values():
        view.flags.writeable = False
    return views


def instances_share_no_state(trial: Trial) -> None:
    """Two of a kind in one process do not feel each other."""
    alone = trial.move(trial.build(), 4)
    component, other = trial.build(), trial.build()
    for number, expected in enumerate(alone, 1):
        (outputs,) = trial.move(component, 1, first=number)
        rule = f"beside another of its kind it must do what it does alone, step {number}"
        require_same_bits(outputs, expected, rule, "Keep state in the instance, not in the class.")
        _disturb(trial, other, number)


def _disturb(trial: Trial, other: Component, number: int) -> None:
    """Let another component of the kind do everything it can."""
    saved = trial.received(other.save())
    trial.move(other, 2, first=20 + number)
    other.load(saved)
    trial.move(trial.build(), 1, first=40 + number)
