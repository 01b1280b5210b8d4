"""Looks at some windows of a run twice, and warns where the coupling is too coarse in time.

Which windows are looked at depends on their number alone. What counts has the same bits whether a
window is looked at or not.
"""

from collections.abc import Mapping
from typing import Any

from quintet.coupler.coupling.judgement.start_check import StartCheck
from quintet.coupler.coupling.judgement.time_error import (
    PIECES,
    FieldError,
    Key,
    TimeErrors,
    is_sampled,
    sample,
)
from quintet.coupler.coupling.judgement.trial_window import Outputs, step_in_pieces
from quintet.coupler.coupling.participant import TrialFailed
from quintet.coupler.coupling.schedule import Coupling
from quintet.interfaces.component import Field, Fields

FEW = 4  # windows of a run of which the first is looked at, too
SAME = 1e-9  # by which two windows of one length may differ, relative
# Estimated errors above which a run is warned. Dust that relaxes to a stream, with velocities that
# are 2, 5, 11, 24 % off: bias of the loads 5, 11, 20, 36 %. Two masses on springs in repeated
# windows, with positions that are 0.8, 4, 13 % off: drift of the motion 4, 12, 48 %. Loads of
# floating bodies that are struck and tumble differ by 12 % from window to window, to and fro.
BIAS_LIMIT, LOAD_LIMIT = 0.1, 0.4
MOTION_LIMIT, DRIFT_LIMIT = 0.05, 0.1
# Change of quaternions over the way of a run, half the angle [rad], that is the rattling of bodies
# in contact: a cube that slides on a floor turns by 1e-4.
SMALL_TURN = 0.01
EARLY, FEWEST = 5.0, 6  # times the limit, and samples: then a run is warned before its end
FORCES = "N", "N m"
AIM = 0.01  # error of the window that is advised


class TimeCheck:
    """Compares windows with the same ones in pieces."""

    def __init__(self) -> None:
        self.errors, self._beginning = TimeErrors(), StartCheck()
        self._pieces: Outputs | None = None
        self._start: dict[str, Fields] = {}

    def before(self, coupling: Coupling) -> None:
        """Step the coming window in pieces, if it is one to be looked at."""
        windows, errors = coupling.windows, self.errors
        errors.due = errors.due or is_sampled(windows.done + 1)
        if not errors.due or errors.skipped or not judged(coupling):
            return
        saved = windows.save()
        ticks = windows.next(coupling.allowed())
        windows.load(saved)
        if not windows.done and FEW * ticks < windows.end:
            errors.due = False  # components may compile or fail in their first window: say so soon
            return
        dt, last = ticks * windows.tick, coupling.last_dt
        if last and abs(dt - last) > SAME * last:
            return  # what is late belongs to a window of another length
        errors.due, self._start = False, dict(coupling.outputs)
        try:
            (self._pieces,) = step_in_pieces(coupling, ticks, (PIECES,))
        except TrialFailed as error:
            errors.skipped = str(error)

    def check(self, coupling: Coupling) -> dict[str, dict[str, str]]:
        """Compare the window with its pieces, if it was stepped so; warn early of large errors."""
        pieces, self._pieces = self._pieces, None
        self._beginning.check(coupling, _moves(coupling) if coupling.windows.done <= 2 else ())
        if pieces is None:
            return {}
        samples = {}
        for name, path in judged(coupling):
            field, whole = coupling.exchange.gives[name][path], coupling.outputs[name][path]
            start = None if field.centring == "impulse" else self._start[name][path]
            samples[name, path] = sample(whole, pieces[name, path], start, field.kind)
        self.errors.add(coupling.windows.done, samples)
        return self._coarse_windows(coupling, EARLY, FEWEST)

    def final_warnings(self, coupling: Coupling) -> dict[str, dict[str, str]]:
        """Warn of every link whose estimated error is above its limit, or whose start is late."""
        texts = self._coarse_windows(coupling)
        for key, link in _moves(coupling).items():
            if text := self._beginning.warning(key, coupling.last_dt):
                texts.setdefault(link, {})["start"] = text
        return texts

    def suspects(self, coupling: Coupling) -> list[str]:
        """Links whose windows were too long so far, in sentences."""
        coarse = self._coarse_windows(coupling)
        return [f"link {link}: {texts['window']}" for link, texts in coarse.items()]

    def _coarse_windows(
        self, coupling: Coupling, factor: float = 1.0, samples: int = 1
    ) -> dict[str, dict[str, str]]:
        """Texts of the links whose estimated error is above so many times its limit."""
        fields = self.errors.fields
        return {
            link: {"window": _text(coupling, link, key, fields[key])}
            for link, (key, over) in _worst_fields(coupling, fields).items()
            if over > factor and fields[key].samples >= samples
        }

    def save(self) -> dict[str, Any]:
        """All of it, for a snapshot."""
        return {"errors": self.errors.save(), "start": self._beginning.save()}

    def load(self, state: Mapping[str, Any]) -> None:
        """Come back to what was saved."""
        self.errors.load(state["errors"])
        self._beginning.load(state["start"])


def _moves(coupling: Coupling) -> dict[Key, str]:
    """Positions by which links are judged whose windows are those of the run, and the links."""
    fields = {key: coupling.exchange.gives[key[0]][key[1]] for key in judged(coupling)}
    return {
        key: link
        for key, link in judged(coupling).items()
        if fields[key].rate and fields[key].kind == "value" and coupling.carries(link) is coupling
    }


def _worst_fields(
    coupling: Coupling, errors: Mapping[Key, FieldError]
) -> dict[str, tuple[Key, float]]:
    """Field of each link with the largest error over its limit, and that ratio."""
    worst: dict[str, tuple[Key, float]] = {}
    for key, link in judged(coupling).items():
        if key in errors:
            over = _over(errors[key], coupling.exchange.gives[key[0]][key[1]])
            if over > worst.get(link, (key, 0.0))[1]:
                worst[link] = key, over
    return worst


def _over(error: FieldError, field: Field) -> float:
    """How many times its limit the estimated error of a field is."""
    if field.kind == "rotation" and error.change < SMALL_TURN:
        return 0.0
    if field.centring == "impulse":
        return max(error.bias / BIAS_LIMIT, error.local / LOAD_LIMIT)
    return max(error.local / MOTION_LIMIT, error.drift / DRIFT_LIMIT)


def judged(coupling: Coupling) -> dict[Key, str]:
    """Outputs by which links are judged, and the links: loads, and instants that add up a rate.

    A force that comes a window late changes a velocity back and forth, not the way. Torques are
    judged by the rotations that they make, as those of symmetric bodies are rounding. Of a link
    that demands equal steps the forces hold two sides together, whatever the step. A link that
    must settle is an iteration from window to window, not steps in time.
    """
    exchange = coupling.exchange
    keys: dict[Key, str] = {}
    for number, link in enumerate(exchange.links):
        demands = link.demands()
        if demands.relaxation or demands.settles or not demands.judged:
            continue
        crossing = [
            (transfer.giver, key)
            for at, transfer in enumerate(exchange.transfers)
            if exchange.link_of[at] == number
            for key in transfer.reads
        ]
        fields = {(name, key): exchange.gives[name][key] for name, key in crossing}
        fields = {key: field for key, field in fields.items() if field.kind != "flag"}
        loads = [key for key, field in fields.items() if field.centring == "impulse"]
        moves = [key for key, field in fields.items() if field.rate]
        if demands.equal_steps:
            chosen = [key for key, field in fields.items() if field.unit not in FORCES]
        elif loads:
            chosen = [*moves, *(key for key in loads if fields[key].unit != FORCES[1])]
        else:
            chosen = list(fields)
        keys |= dict.fromkeys(chosen, link.name)
    return keys


def _error_of_load(estimate: FieldError) -> float:
    """Estimate by which a load is judged: that which is more times its limit."""
    by_bias = estimate.bias / BIAS_LIMIT >= estimate.local / LOAD_LIMIT
    return estimate.bias if by_bias else estimate.local


def _text(coupling: Coupling, link: str, key: Key, estimate: FieldError) -> str:
    error = estimate.motion if len(estimate.low) else _error_of_load(estimate)
    inner = coupling.carries(link) or coupling
    window, place = inner.last_dt, f"groups.{inner.plan.name}." if inner.plan.name else ""
    order = 2.0 if inner.plan.scheme == "iterated" else 1.0
    shorter = window * (AIM / error) ** (1.0 / order)
    return (
        f"windows of {window:.3g} s are too long: {'.'.join(key)} is wrong by about "
        f"{100.0 * min(error, 1.0):.0f} % of its change or more, estimated by windows that were "
        f"repeated in {PIECES} parts. Set {place}window to {shorter:.1g} s or less."
    )
