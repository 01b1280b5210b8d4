"""The loop that every component runs, whatever line it hangs on.

Substeps, interpolation and the summing of impulses are done here, once for all components.
"""

import math
import reprlib
import sys
import time
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from quintet.interfaces.component import Component, Fields, outputs_of
from quintet.interfaces.errors import (
    LineError,
    MessageError,
    OrderError,
    PortError,
    SceneError,
    StepError,
)
from quintet.interfaces.lines.message import Message, require_finite
from quintet.interfaces.lines.transport import Line
from quintet.interfaces.serving.failing import failure, shown_at_failure
from quintet.interfaces.serving.inputs import Inputs
from quintet.interfaces.serving.order_guard import OrderGuard
from quintet.interfaces.serving.orders import check_order
from quintet.interfaces.serving.outputs import InputAudit, Outputs, Sums
from quintet.interfaces.serving.port_view import look_at
from quintet.interfaces.serving.states import parts_of, unlike
from quintet.interfaces.sums import column_sums

Answer = tuple[dict[str, Any], Fields]
TRIED = 1e-3  # of the stable step: the length of a step that is undone
MOST = 1e9  # steps in a window; more would never end
# s between two orders, in which others may build or compute; the coupler's death ends the wait.
LONGEST_WAIT = 86400.0


def divide(left: float, stable: float) -> int:
    """Fewest equal steps into which the rest of a window falls."""
    if not stable > 0.0:  # also true of nan
        raise StepError(f"stable_dt must be positive; it is {stable}. Look at the state.")
    if left > MOST * stable:
        raise StepError(
            f"stable_dt must be above {left / MOST:.1e} s, {MOST:.0e} steps to the end of this "
            f"window; it is {stable}. Look at the state."
        )
    return max(1, math.ceil(left / stable - 1e-9)) if math.isfinite(stable) else 1


class Server:
    """Carries out the coupler's orders on one component."""

    outputs_class = Outputs

    def __init__(
        self,
        component: Component,
        name: str,
        build_seconds: float = 0.0,
        spread: Callable[[Fields], Fields] | None = None,
    ) -> None:
        self.component, self.build_seconds = component, build_seconds
        self.is_alone = spread is None  # whether it has one rank
        # Gives a saved state to all ranks of the component.
        self._spread = spread or (lambda state: state)
        self.guard = OrderGuard(name)
        self.inputs = Inputs(component.takes)
        self.outputs = self.outputs_class(component.gives, component.gives_integrals)
        fields = self.inputs.fields
        # Turns about several axes do not add up: of rotations the first step alone is checked.
        rates = {k: v for k, v in self.inputs.rates.items() if fields[k].kind != "rotation"}
        self.input_audit = InputAudit(sorted(fields.keys() - self.inputs.impulses), rates)
        self._kept: dict[int, dict[str, Any]] = {}  # states, by depth of the coupling that repeats
        self._reported = 0  # notes
        self._prepared = 0.0  # s, spent on the outputs of the start
        self._stable: float | None = None  # s, as told at the end of the last window
        self._orders: dict[str, Callable[[Message], Answer]] = {
            "describe": self._describe,
            "sample": lambda request: ({}, self.component.sample(request.fields)),
            "bind": self._bind,
            "begin": self._begin,
            "prime": self._prime,
            "prepare": self._prepare,
            "give": self._give,
            "advance": self._advance,
            "keep": self._keep,
            "rewind": self._rewind,
            "save": self._save,
            "load": self._load,
            "view": self._view,
            "conclude": self._conclude,
            "finish": lambda _: ({"memory": peak_memory(), "cpu": 0.0}, {}),
        }

    def handle(self, message: Message) -> Answer:
        """Carry out one order."""
        check_order(message.order, message.header)
        self.guard.allow(message.order, message.header.get("window", 0), depth(message))
        return self._orders[message.order](message)

    def _describe(self, _: Message) -> Answer:
        return {"seconds": self.build_seconds}, self.component.describe()

    def _bind(self, message: Message) -> Answer:
        header = message.header
        self.component.bind(message.fields, frozenset(header.get("joined", ())))
        if "wanted" in header:
            self.outputs.want(header["wanted"])
        for force, velocity, position in header.get("works", []):
            taken = self.inputs.fields
            if position and position not in taken:
                raise OrderError(f"order bind: {reprlib.repr(position)} is not taken here.")
            if force in self.outputs.through and velocity in taken:
                self.outputs.works.append((force, velocity, position))
        return {"items": self.component.items()}, {}

    def stable(self) -> float:
        """Largest step that the component allows now [s]."""
        if self._stable is None:
            self._stable = float(self.component.stable_dt())
        return self._stable

    def _prime(self, message: Message) -> Answer:
        require_finite(message.fields, "as the run begins")
        self.outputs.shares = message.header.get("shares", {})
        self.inputs.arrive(message.fields, (), 1.0)
        self.component.prime(message.fields)
        return {"notes": self._notes()}, {}

    def _prepare(self, _: Message) -> Answer:
        """Compile: find the stable step, and try one where the component asks for it."""
        began = time.perf_counter()
        if self.component.compiles:
            self._try_step()
        self._stable = None
        stable = self.stable()
        return {"stable": stable, "seconds": self._prepared + time.perf_counter() - began}, {}

    def _try_step(self) -> None:
        """Take the inputs of the start, step and give, then restore the state."""
        component = self.component
        state = component.save()
        component.take(self.inputs.at_start())
        component.step(TRIED * component.stable_dt())
        outputs_of(component)
        component.load(self._spread(state))

    def _give(self, _: Message) -> Answer:
        began = time.perf_counter()
        self.outputs.begin()
        fields = self.outputs.collect(self._given(self.outputs.wanted))
        self._prepared += time.perf_counter() - began
        return {}, fields

    def _advance(self, message: Message) -> Answer:
        header, began, spent = message.header, time.perf_counter(), time.process_time()
        window = float(header["dt"])
        require_finite(message.fields, f"window {header['window']}, received")
        self.inputs.arrive(message.fields, header["ends"], window)
        impulses = self.inputs.impulses
        received = {key: column_sums(v) for key, v in message.fields.items() if key in impulses}
        steps, applied, outputs = self.advance(window, int(header.get("steps", 0)))
        self.component.check()
        fields = self.outputs.collect(outputs)
        answer = {
            "steps": steps,
            "stable": self.stable(),
            "sent": self.outputs.audit(),
            "received": received,
            "applied": applied,
            "inputs": self.input_audit.audit(),
        }
        if header.get("totals"):
            answer["totals"] = self._totals()
        answer["busy"] = time.perf_counter() - began
        answer["cpu"] = time.process_time() - spent
        if is_trial(message):
            return answer, fields
        if notes := self._notes():
            answer["notes"] = notes
        if warnings := self.component.warnings():
            answer["warnings"] = _texts(warnings)
        return answer, fields

    def _conclude(self, _: Message) -> Answer:
        warnings = self.component.final_warnings()
        if not isinstance(warnings, Mapping):
            raise PortError(
                "final_warnings() must return texts by subject; found "
                f"{type(warnings).__name__}. Return {{}} where there are none."
            )
        return {"warnings": _texts(warnings)}, {}

    def _notes(self) -> list[str]:
        """Notes of the component that were not yet told."""
        notes = self.component.notes()
        reported, self._reported = self._reported, len(notes)
        return [str(note) for note in notes[reported:]]

    def advance(self, window: float, count: int = 0) -> tuple[int, Sums, Fields]:
        """Step through a window [s]; tell the steps, the impulses applied, the last outputs.

        With `count` in that many equal steps, else in the fewest that are stable.
        """
        component, inputs, outputs = self.component, self.inputs, self.outputs
        outputs.begin()
        self.input_audit.begin()
        applied = {key: np.zeros(rate[0].size) for key, rate in inputs.rate.items() if len(rate)}
        sums = {key: np.asarray(column_sums(inputs.rate[key])) for key in applied}
        done, steps = 0.0, 0
        outputs_now: Fields = {}
        while done < window:
            pieces = divide(window - done, self.stable())
            if count:
                pieces = self._pieces(count - steps, window - done)
            dt = (window - done) / pieces
            end = window if pieces == 1 else done + dt
            taken: Fields = {}
            if steps == 0 or not inputs.constant:
                taken = inputs.over(done, end, window)
                component.take(taken)
                self.input_audit.add(taken, dt)
            component.step(dt)
            self._stable = None
            if pieces == 1:
                outputs_now = self._given(outputs.wanted)
            elif outputs.through:
                outputs_now = self._given(outputs.through)
            if outputs.through:
                outputs.add(outputs_now, taken or inputs.rate, dt)
            for key in applied:
                applied[key] += dt * sums[key]
            done, steps = end, steps + 1
        return steps, {key: total.tolist() for key, total in applied.items()}, outputs_now

    def _given(self, wanted: frozenset[str]) -> Fields:
        """Fields that the component gives now, checked."""
        return self.outputs.check(self.component.give(wanted))

    def _pieces(self, left: int, time: float) -> int:
        """Check that the steps which a link demands are stable."""
        if time > left * self.stable() * (1.0 + 1e-9):
            raise StepError(
                f"a link with equal steps requires {left} step(s) of {time / left:.6g} s; the "
                f"largest stable step is {self.stable():.6g} s. Shorten the window."
            )
        return left

    def _totals(self) -> dict[str, Any]:
        totals = self.component.totals()
        masses = {str(reason): float(mass) for reason, mass in totals.mass_balance.items()}
        return {
            "mass": float(totals.mass),
            "momentum": [float(p) for p in totals.momentum],
            "angular_momentum": [float(p) for p in totals.angular_momentum],
            "kinetic": float(totals.kinetic),
            "potential": float(totals.potential),
            "internal": float(totals.internal),
            "work": float(totals.work),
            "dissipated": None if totals.dissipated is None else float(totals.dissipated),
            **({"mass_balance": masses} if masses else {}),
        }

    def state(self) -> dict[str, Any]:
        """All that must come back: the component's own state and its inputs."""
        arrays = {f"component/{key}": array for key, array in self.component.save().items()}
        return arrays | {f"inputs/{key}": array for key, array in self.inputs.save().items()}

    def _begin(self, message: Message) -> Answer:
        """Begin from a state of another run; with its inputs where that run is gone on with."""
        parts = parts_of(message.fields)
        try:
            self.component.begin_from(parts["component"])
        except (LookupError, TypeError, ValueError) as error:
            difference = unlike(parts["component"], self.component.save()) or str(error)
            raise SceneError(
                "the state that it begins from must be one of a component like this; "
                f"{difference}. "
                "Keep its bodies, meshes and resolution as in that run."
            ) from error
        self._stable = None
        if not message.header.get("goes_on"):
            return {}, {}
        self.inputs.load(parts["inputs"])
        return {"stable": self.stable()}, {}

    def restore(self, state: Fields) -> None:
        """Come back to a state."""
        parts = parts_of(state)
        try:
            self.component.load(parts["component"])
        except (LookupError, TypeError, ValueError) as error:
            if text := unlike(parts["component"], self.component.save()):
                raise OrderError(f"a state must be one that was saved here; {text}.") from error
            raise
        self._stable = None
        self.inputs.load(parts["inputs"])

    def _keep(self, message: Message) -> Answer:
        state = self._kept[depth(message)] = self.state()
        return {"stateless": not any(key.startswith("component/") for key in state)}, {}

    def _rewind(self, message: Message) -> Answer:
        states, at = self._kept, depth(message)
        if at not in states:
            raise OrderError(f"rewind needs a state that was kept; found none at depth {at}.")
        state = states.pop(at) if message.header.get("last") else states[at]
        self.restore(self._spread(state))
        return {}, {}

    def _save(self, _: Message) -> Answer:
        return {}, self.state()

    def _load(self, message: Message) -> Answer:
        self.restore(message.fields)
        return {"stable": self.stable()}, {}

    def _view(self, message: Message) -> Answer:
        """Totals; where asked for, what there is to see and the units of its fields, and walls."""
        header: dict[str, Any] = {"totals": self._totals()}
        fields: dict[str, Any] = {}
        if message.header.get("shown", True):
            shown, header["units"] = look_at(self.component)
            fields |= shown
        if message.header.get("walls"):
            header["walls_move"] = bool(self.component.walls_move)
            fields |= {f"walls.{key}": array for key, array in self.component.walls().items()}
        return header, fields


def _texts(warnings: Mapping[str, str]) -> dict[str, str]:
    return {str(subject): str(text) for subject, text in warnings.items()}


def depth(message: Message) -> int:
    """How deep in groups the coupling is that keeps a state; 0 is the whole run."""
    return int(message.header.get("depth", 0))  # checked before


def is_trial(message: Message) -> bool:
    """Whether an order belongs to a trial: windows that are undone afterwards."""
    return bool(message.header.get("trial", False))  # checked before


def peak_memory() -> int:
    """Largest resident memory of this process so far [bytes]."""
    with open("/proc/self/status") as status:
        return next(1024 * int(line.split()[1]) for line in status if line.startswith("VmHWM"))


def answer(server: Server, line: Line, message: Message) -> bool:
    """Handle one order and send the answer; tell whether to go on."""
    try:
        header, fields = server.handle(message)
        header["order"] = "done"
        line.send(header, fields)
    except LineError:
        raise
    except (Exception, SystemExit) as error:
        report = failure(error)
        if is_trial(message):  # it comes back to the state before, and the run goes on
            line.send({**report, "order": "unable", "traceback": ""}, {})
            return True
        print(report["traceback"], end="", file=sys.stderr, flush=True)  # into the component's log
        is_told = server.is_alone and message.order == "advance"
        more, shown = shown_at_failure(server.component, error) if is_told else ({}, {})
        try:
            line.send({**report, **more}, shown)
        except MessageError:  # too large for the line
            line.send(report, {})
        return False
    return message.order != "finish"


def serve(server: Server, line: Line) -> bool:
    """Answer the coupler until it says finish; tell whether all went well."""
    while True:
        message = line.receive(LONGEST_WAIT)
        if message.order == "abort":
            return False
        if not answer(server, line, message):
            return message.order == "finish"
