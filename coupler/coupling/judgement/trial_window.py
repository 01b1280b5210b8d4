"""A window stepped in shorter pieces, as a trial: afterwards everything is as it was before.

The components keep their states and come back to them; nothing of a trial is booked, recorded,
or counted in the times of the components.
"""

import dataclasses
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress

import numpy as np

from quintet.coupler.coupling.group import Group
from quintet.coupler.coupling.participant import ComponentFailed, TrialFailed
from quintet.coupler.coupling.schedule import Coupling, Window
from quintet.coupler.coupling.schemes import SCHEMES
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.errors import StepError

DEPTH = 1 << 20  # of the states kept: no group is so deep
Outputs = dict[tuple[str, str], Array]  # by component and field


def step_in_pieces(
    coupling: Coupling, ticks: int, pieces: Sequence[int], extrapolate: bool = False
) -> list[Outputs]:
    """Step the next window [ticks] of the run in equal pieces, and come back to its start.

    Parameters
    ----------
    pieces : sequence of ints
        Number of pieces of each of several trials.
    extrapolate : bool
        Whether the impulses that the first piece receives from the window before are those of that
        window's last piece, extrapolated from the last two windows, which must have the length of
        this one. Then the error is that of a run in windows as short as the pieces.

    Returns
    -------
    list of mappings
        Of each trial: instants at the window's end, and impulses of the whole window.

    Raises
    ------
    TrialFailed
        If a component cannot keep its state or cannot step so. The state is that of before.
    """
    trials: list[Outputs] = []
    with _undone(coupling) as restore:
        _keep(coupling)
        for number in pieces:
            is_last = len(trials) + 1 == len(pieces)
            try:
                trials.append(_steps(coupling, ticks, number, extrapolate))
            except StepError as error:  # repeated windows that did not agree
                is_last = True
                raise TrialFailed(str(error)) from error
            except TrialFailed:
                is_last = True
                raise
            finally:
                _rewind(coupling, is_last)
                restore()
    return trials


def _steps(coupling: Coupling, ticks: int, pieces: int, extrapolate: bool) -> Outputs:
    whole, outputs = ticks * coupling.windows.tick, Outputs()
    _shorten_late_impulses(coupling, whole / pieces, extrapolate)
    for number in range(pieces):
        part = ticks * (number + 1) // pieces - ticks * number // pieces
        exact = ticks >= pieces
        dt = part * coupling.windows.tick if exact else whole / pieces
        window = Window(coupling.windows.done, part if exact else 1, dt, False)
        SCHEMES[coupling.plan.scheme](coupling, window)
        coupling.last_dt = dt
        for name, fields in coupling.outputs.items():
            for key, array in fields.items():
                place, field = (name, key), coupling.exchange.gives[name][key]
                summed = field.centring == "impulse" and place in outputs
                outputs[place] = outputs[place] + array if summed else array
    return outputs


def _shorten_late_impulses(coupling: Coupling, dt: float, extrapolate: bool) -> None:
    """Let impulses that wait for the next window be those of one as long as a piece [s].

    Else the first piece would get the impulse of a whole window, at many times the rate.
    """
    if not coupling.late:
        return
    share = dt / coupling.last_dt
    # From the middle of the last window to the middle of a piece at its end, in windows.
    ahead = 0.5 * (1.0 - share) if extrapolate else 0.0
    for number in coupling.late:
        transfer = coupling.exchange.transfers[number]
        gives, giver = coupling.exchange.gives[transfer.giver], transfer.giver
        late = {key for key in transfer.reads if gives[key].centring == "impulse"}
        before = coupling.previous[giver]
        coupling.outputs[giver] = {
            key: _piece_of(array, before.get(key), share, ahead) if key in late else array
            for key, array in coupling.outputs[giver].items()
        }


def _piece_of(last: Array, before: Array | None, share: float, ahead: float) -> Array:
    """Impulse of a piece, from those of the last two windows."""
    if not ahead or before is None:
        return last * share
    return np.asarray((last + ahead * (last - before)) * share)


def _keep(coupling: Coupling) -> None:
    stateless = []
    for participant in coupling.components.values():
        participant.order_keep(DEPTH)
    try:
        for name, participant in coupling.components.items():
            if participant.receive().header.get("stateless"):
                stateless.append(name)
    finally:
        _await_all(coupling)
    if stateless:
        raise TrialFailed(f"{', '.join(stateless)} keeps no state.")


def _rewind(coupling: Coupling, is_last: bool) -> None:
    components = coupling.components.values()
    _await_all(coupling)
    for participant in components:
        participant.order_rewind(DEPTH, last=is_last)
    for participant in components:
        participant.receive()


def _await_all(coupling: Coupling) -> None:
    """Wait for the components that were under way when another failed."""
    for participant in coupling.components.values():
        while not participant.answered:
            with suppress(TrialFailed):
                participant.receive()


@contextmanager
def _undone(coupling: Coupling) -> Iterator[Callable[[], None]]:
    """Bring the coupler's memory back at the end: couplings, books, logs and costs.

    Yields what brings back the couplings and books alone, for another trial.
    """
    began = time.perf_counter()
    groups = {k: group for k, group in coupling.members.items() if isinstance(group, Group)}
    state, books = coupling.save(), coupling.ledger.save()
    inner = {name: group.save() for name, group in groups.items()}
    couplings = list(_couplings(coupling))
    logs, costs = [each.log for each in couplings], dataclasses.replace(coupling.costs)
    before = dict(coupling.outputs)
    for participant in coupling.components.values():
        participant.trial = True
    for each in couplings:
        each.log = None

    def restore() -> None:
        coupling.load(state)
        for name, group in groups.items():
            group.load(inner[name])
        coupling.ledger.load(books)

    try:
        yield restore
    finally:
        for participant in coupling.components.values():
            participant.trial = False
        restore()
        for each, log in zip(couplings, logs, strict=True):
            each.log = log
        for item in dataclasses.fields(costs):
            setattr(coupling.costs, item.name, getattr(costs, item.name))
        coupling.costs.checks += time.perf_counter() - began
    _require_undone(coupling, before)


def _couplings(coupling: Coupling) -> Iterator[Coupling]:
    yield coupling
    for member in coupling.members.values():
        if member.inner is not None:
            yield from _couplings(member.inner)


def _require_undone(coupling: Coupling, before: Mapping[str, Fields]) -> None:
    """End the run if a component did not come back: it would go on from a wrong state."""
    for name, participant in coupling.components.items():
        gives, now = coupling.exchange.gives[name], participant.call("give").fields
        for key, array in before[name].items():
            if gives[key].centring == "instant" and not np.array_equal(now.get(key, ()), array):
                raise ComponentFailed(
                    name,
                    participant.window,
                    f"load must restore what save returned; {key} differs after a window was "
                    "undone. Run quintet conform on its kind.",
                )
