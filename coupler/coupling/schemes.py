"""Who steps when: serial and parallel staggered windows, and windows iterated to agreement.

Literature: Farhat and Lesoinne (2000), Comput. Methods Appl. Mech. Engrg. 182, 499, for the
staggered schemes; `acceleration` for those of repeated windows.
"""

from collections.abc import Callable

from quintet.coupler.coupling.exchange import WindowInputs
from quintet.coupler.coupling.iteration.convergence_log import ConvergenceRow
from quintet.coupler.coupling.iteration.convergence_measure import allowed, converged
from quintet.coupler.coupling.schedule import Coupling, Given, Guess, Window
from quintet.interfaces.errors import StepError

Scheme = Callable[[Coupling, Window], None]
Inputs = dict[str, WindowInputs]


def advance(coupling: Coupling, totals: Callable[[int], bool] = lambda _: False) -> None:
    """Step a coupling through its next window; `totals` says whether they are due at its end."""
    windows = coupling.windows
    ticks = windows.next(coupling.allowed())
    window = Window(windows.done, ticks, ticks * windows.tick, totals(windows.now + ticks))
    SCHEMES[coupling.plan.scheme](coupling, window)
    windows.advance(ticks)
    coupling.last_dt = window.dt


def serial(coupling: Coupling, window: Window) -> None:
    """One after the other: each sees the window's end of those before it."""
    stepped: list[str] = []
    for name in coupling.members:
        inputs = coupling.collect_inputs(name, stepped, window)
        coupling.start(name, window, inputs)
        _conclude(coupling, name, coupling.finish(name, window), inputs, window)
        stepped.append(name)
    coupling.late = {
        number
        for number, (giver, taker) in coupling.transfers.items()
        if stepped.index(taker) <= stepped.index(giver)
    }


def parallel(coupling: Coupling, window: Window) -> None:
    """All at once: each sees the others as they were at the window's beginning."""
    inputs = {name: coupling.collect_inputs(name, (), window) for name in coupling.members}
    for name in coupling.members:
        coupling.start(name, window, inputs[name])
    answers = {name: coupling.finish(name, window) for name in coupling.members}
    for name, answer in answers.items():
        _conclude(coupling, name, answer, inputs[name], window)
    coupling.late = set(coupling.transfers)


def _conclude(
    coupling: Coupling, name: str, answers: Given, inputs: Inputs, window: Window
) -> None:
    coupling.members[name].book(coupling, window)
    coupling.book(answers, inputs, window)
    coupling.advance_outputs(answers)


def iterated(coupling: Coupling, window: Window) -> None:
    """Repeat the serial window until what goes back to the first members agrees.

    What the last repetition still lacked of an impulse is added in the next window, so that
    momentum closes to rounding although the iteration stops at its tolerance.
    """
    acceleration, measure = coupling.acceleration, coupling.measure
    before, earlier = dict(coupling.outputs), dict(coupling.previous)
    sent = dict(coupling.sent)
    guess = _first_guess(coupling, window)
    acceleration.begin_window(window.dt)
    guessing = [  # members whose inputs are guessed
        name
        for name, member in coupling.members.items()
        if any(k in member.components for k, _ in guess)
    ]
    _all(coupling, "keep")
    repetition = 0
    while True:
        inputs, answers = _sweep(coupling, window, guess)
        everyone = list(coupling.members)
        taken = {name: coupling.collect_inputs(name, everyone, window) for name in guessing}
        result = {
            (component, key): _inputs_of(taken, component).fields[key] for component, key in guess
        }
        residuals = measure.compare(guess, result, window.dt)
        if converged(residuals):
            break
        if repetition + 1 >= coupling.plan.iteration.limit:
            _at_limit(coupling, window, repetition)
            break
        guess = acceleration.next(guess, result, allowed(residuals))
        repetition += 1
        coupling.iterate = dict(coupling.outputs)
        _all(coupling, "rewind")
        coupling.outputs, coupling.previous = dict(before), dict(earlier)
        coupling.sent = dict(sent)
    acceleration.end_window(guess, result)
    coupling.iterate = {}
    coupling.costs.repetitions += repetition
    if coupling.log:
        coupling.log.write(ConvergenceRow(window.number, repetition, residuals))
    guessed = {component for component, _ in guess}
    coupling.outputs = dict(before)
    for name, answer in answers.items():
        for component, mine in inputs[name].items():
            mine.outputs = before[component]
            if component in guessed:  # the mapping that counts is that of the agreed outputs
                agreed = taken[name][component]
                mine.deliveries, mine.sent = agreed.deliveries, agreed.sent
        coupling.members[name].book(coupling, window)
        coupling.book(answer, inputs[name], window)
    for answer in answers.values():
        coupling.outputs |= answer.outputs
    coupling.in_transit = {
        key: result[key] - guess[key] for key in guess if coupling.exchange.is_impulse(*key)
    }
    coupling.late = set()


def _at_limit(coupling: Coupling, window: Window, repetition: int) -> None:
    """End the run, or flag the window and go on, as the scene says."""
    if coupling.plan.iteration.at_limit == "continue":
        coupling.costs.unconverged += 1
        return
    raise StepError(
        f"window {window.number} did not converge within {coupling.plan.iteration.limit} "
        "iterations. Shorten the window, lower "
        "iteration.relaxation, try acceleration iqn-ils, raise iteration.limit, or let "
        "iteration.at_limit be continue."
    )


def _sweep(
    coupling: Coupling, window: Window, guess: Guess
) -> tuple[dict[str, Inputs], dict[str, Given]]:
    """Step all members once with guessed inputs where the true ones come later."""
    stepped: list[str] = []
    booked: dict[str, Inputs] = {}
    gave: dict[str, Given] = {}
    for name in coupling.members:
        inputs = coupling.collect_inputs(name, stepped, window)
        for (component, key), value in guess.items():
            if component in inputs:
                mine = inputs[component]
                lacking = coupling.in_transit.get((component, key), 0.0)
                mine.fields[key] = value + lacking
                mine.ends.append(key)
        coupling.start(name, window, inputs)
        gave[name] = coupling.finish(name, window)
        coupling.advance_outputs(gave[name])
        booked[name] = inputs
        stepped.append(name)
    return booked, gave


def _inputs_of(taken: dict[str, Inputs], component: str) -> WindowInputs:
    return next(inputs[component] for inputs in taken.values() if component in inputs)


def _first_guess(coupling: Coupling, window: Window) -> Guess:
    """Inputs that come, wholly or in part, from members which step after their taker.

    They are guessed to be those of the last window; impulses as rates, since windows differ.
    """
    names = list(coupling.members)
    stretch = window.dt / coupling.last_dt if coupling.last_dt else 1.0
    guess: Guess = {}
    for number, name in enumerate(names):
        for component, inputs in coupling.collect_inputs(name, names[:number], window).items():
            for key, array in inputs.fields.items():
                if key not in inputs.ends:
                    impulse = coupling.exchange.is_impulse(component, key)
                    guess[component, key] = array * stretch if impulse else array
    return guess


def _all(coupling: Coupling, order: str) -> None:
    for member in coupling.members.values():
        member.keep(coupling.depth) if order == "keep" else member.rewind(coupling.depth)
    for member in coupling.members.values():
        member.confirm()


SCHEMES: dict[str, Scheme] = {"serial": serial, "parallel": parallel, "iterated": iterated}
