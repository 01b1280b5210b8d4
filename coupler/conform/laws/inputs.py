"""Laws of what a component is given, and of ports that have no partner."""

from collections.abc import Callable

import numpy as np

from quintet.coupler.conform.trial import Trial, copies
from quintet.coupler.conform.verdict import (
    DoesNotApply,
    LawBroken,
    raised,
    require,
    require_same_bits,
)
from quintet.interfaces.component import Array, Component, Fields
from quintet.interfaces.errors import QuintetError

SPOILT = 1e9  # what buffers hold after their arrays were read


def received_arrays_are_neither_written_to_nor_kept(trial: Trial) -> None:
    """Buffers of a line are read-only and used again: what they hold later must not matter."""
    rule = "take, bind: arrays that come in must not be kept, as their memory is used again"
    remedy = "Keep copies: np.array(fields[key])."
    expected = _received(trial, False)
    try:
        outputs = _received(trial, True)
    except LawBroken:
        raise
    except Exception as error:
        raise LawBroken(f"{rule}; when it held {SPOILT:g}, {raised(error)}. {remedy}") from error
    require_same_bits(outputs, expected, rule, remedy)


def _received(trial: Trial, spoils: bool) -> Fields:
    """Outputs after some steps; after each call, what came in is spoilt if that is asked for."""
    component = trial.make()
    component.describe()
    buffers = copies(trial.static())
    _hand("bind", lambda views: component.bind(views, trial.joined), buffers)
    _spoil(buffers, spoils)
    for number in (1, 2):
        buffers = copies(trial.inputs(number))
        _hand("take", component.take, buffers)
        _spoil(buffers, spoils)
        for _ in range(2):
            component.step(trial.case.dt)
    return trial.give(component)


def _hand(verb: str, receive: Callable[[Fields], None], buffers: dict[str, Array]) -> None:
    """Hand over read-only views of buffers, and see that these stay as they are."""
    sent = copies(buffers)
    rule = f"{verb}: arrays that come in must not be written to"
    try:
        receive(_read_only(buffers))
    except ValueError as error:
        if "read-only" not in str(error):
            raise
        raise LawBroken(f"{rule}; it failed with {raised(error)}. Work on copies.") from error
    require_same_bits(buffers, sent, rule, "Work on copies.")


def _read_only(buffers: dict[str, Array]) -> Fields:
    views = {key: array.view() for key, array in buffers.items()}
    for view in views.values():
        view.flags.writeable = False
    return views


def _spoil(buffers: dict[str, Array], spoils: bool) -> None:
    for buffer in buffers.values() if spoils else ():
        buffer[...] = SPOILT


def ports_may_be_left_unjoined(trial: Trial) -> None:
    """Without a partner at a port it runs, or refuses in bind; and it keeps no more state."""
    whole = _size(_moved(trial, ""))
    for port in trial.takes:
        if port.name not in trial.joined:
            continue
        try:
            component = trial.build(without=port.name)
        except QuintetError:
            continue  # it says what it cannot do without
        try:
            trial.move(component, wanted=frozenset(), without=port.name)
        except Exception as error:
            raise LawBroken(
                "a component must do without ports that bind says have no partner; left out "
                f"{port.name}, it failed with {raised(error)}. Read inputs with "
                "fields.get, or refuse in bind with a PortError."
            ) from error
        size = _size(component)
        require(
            size <= whole,
            f"a port without a partner must cost nothing; without {port.name} the state has "
            f"{size} bytes, with it {whole}. Make room for it in bind, if it is joined.",
        )


def alone_it_runs_and_gives_nothing(trial: Trial) -> None:
    """Alone, with no partner at any port, it runs, or refuses in bind."""
    component = trial.make()
    component.describe()
    try:
        component.bind({}, frozenset())
    except QuintetError as error:
        raise DoesNotApply(f"it refuses to be alone: {error}") from error
    for _ in range(2):
        component.take({})
        component.step(trial.case.dt)
    outputs = component.give(frozenset())
    require(
        not outputs,
        f"give: where nothing is wanted, nothing is given; found {', '.join(outputs)}. Return "
        "{key: ... for key in wanted}.",
    )


def _moved(trial: Trial, without: str) -> Component:
    component = trial.build(without)
    trial.move(component, wanted=frozenset(), without=without)
    return component


def _size(component: Component) -> int:
    return sum(np.asarray(array).nbytes for array in component.save().values())
