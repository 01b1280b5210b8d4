"""The loop that every component runs, whatever line it hangs on.

Substeps, interpolation and the summing of impulses are done here, once for all components.
"""

import math
import time
import traceback
from collections.abc import Callable
from typing import Any

import numpy as np

from quintet.interfaces.component import Component, Fields
from quintet.interfaces.errors import OrderError, QuintetError, StepError
from quintet.interfaces.lines.message import Message, require_finite
from quintet.interfaces.lines.transport import Line
from quintet.interfaces.serving.inputs import Inputs
from quintet.interfaces.serving.order_guard import Guard
from quintet.interfaces.serving.outputs import Handed, Outputs, Sums
from quintet.interfaces.sums import column_sums

Answer = tuple[dict[str, Any], Fields]
MOST = 1e9  # steps in a window; more would never end
PATIENCE = 3600.0  # s between two orders; the coupler's death is noticed at once


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

    def __init__(self, component: Component, name: str) -> None:
        self.component = component
        self.guard = Guard(name)
        self.inputs = Inputs(component.takes)
        self.outputs = Outputs(component.gives)
        instants = set(self.inputs.fields) - self.inputs.impulses
        self.handed = Handed(sorted(instants), self.inputs.rates)
        self._kept: dict[str, Any] = {}
        self._orders: dict[str, Callable[[Message], Answer]] = {
            "describe": self._describe,
            "bind": self._bind,
            "prime": self._prime,
            "give": self._give,
            "advance": self._advance,
            "keep": self._keep,
            "rewind": self._rewind,
            "save": self._save,
            "load": self._load,
            "view": self._view,
            "finish": lambda _: ({"memory": peak_memory()}, {}),
        }

    def handle(self, message: Message) -> Answer:
        """Carry out one order."""
        window = message.header.get("window", 0)
        if not isinstance(window, int):
            raise OrderError(f"a window has a whole number; found {window!r}.")
        self.guard.allow(message.order, window)
        return self._orders[message.order](message)

    def _describe(self, _: Message) -> Answer:
        return {}, self.component.describe()

    def _bind(self, message: Message) -> Answer:
        self.component.bind(message.fields)
        given = set(self.outputs.shapes)
        for force, velocity, position in message.header.get("works", []):
            if force in given and velocity in self.inputs.fields:
                self.outputs.works.append((force, velocity, position))
        return {"items": self.component.items(), "limit": self.component.stable_dt()}, {}

    def _prime(self, message: Message) -> Answer:
        require_finite(message.fields, "as the run begins")
        self.inputs.arrive(message.fields, (), 1.0)
        return {}, {}

    def _give(self, _: Message) -> Answer:
        self.outputs.begin()
        return {}, self.outputs.collect(self.component.give())

    def _advance(self, message: Message) -> Answer:
        header, began, spent = message.header, time.perf_counter(), time.process_time()
        window = float(header["dt"])
        require_finite(message.fields, f"window {header['window']}, received")
        self.inputs.arrive(message.fields, header["ends"], window)
        received = {k: column_sums(v) for k, v in message.fields.items() if self._integral(k)}
        steps, applied, given = self.advance(window)
        fields = self.outputs.collect(given)
        answer = {
            "steps": steps,
            "sent": self.outputs.audit(),
            "received": received,
            "applied": applied,
            "handed": self.handed.audit(),
            "totals": self._totals() if header.get("totals") else None,
            "busy": time.perf_counter() - began,
            "cpu": time.process_time() - spent,
        }
        return answer, fields

    def _integral(self, key: str) -> bool:
        return key in self.inputs.impulses

    def advance(self, window: float) -> tuple[int, Sums, Fields]:
        """Step through a window [s]; tell the steps, the impulses applied, the last outputs."""
        component, inputs, outputs = self.component, self.inputs, self.outputs
        outputs.begin()
        self.handed.begin()
        applied = {key: np.zeros(rate[0].size) for key, rate in inputs.rate.items() if len(rate)}
        sums = {key: np.asarray(column_sums(inputs.rate[key])) for key in applied}
        done, steps = 0.0, 0
        given: Fields | None = None
        while done < window:
            pieces = divide(window - done, component.stable_dt())
            dt = (window - done) / pieces
            end = window if pieces == 1 else done + dt
            taken: Fields = {}
            if steps == 0 or not inputs.constant:
                taken = inputs.over(done, end, window)
                component.take(taken)
                self.handed.add(taken, dt)
            component.step(dt)
            if outputs.impulses:
                given = component.give()
                outputs.add(given, taken or inputs.rate, dt)
            for key in applied:
                applied[key] += dt * sums[key]
            done, steps = end, steps + 1
        final = given if given is not None else component.give()
        return steps, {key: total.tolist() for key, total in applied.items()}, final

    def _totals(self) -> dict[str, Any]:
        totals = self.component.totals()
        return {
            "mass": float(totals.mass),
            "momentum": [float(p) for p in totals.momentum],
            "angular_momentum": [float(p) for p in totals.angular_momentum],
            "kinetic": float(totals.kinetic),
            "potential": float(totals.potential),
            "internal": float(totals.internal),
        }

    def state(self) -> dict[str, Any]:
        """All that must come back: the component's own state and its inputs."""
        own = {f"component/{key}": array for key, array in self.component.save().items()}
        return own | {f"inputs/{key}": array for key, array in self.inputs.save().items()}

    def restore(self, state: Fields) -> None:
        """Come back to a state."""
        parts: dict[str, dict[str, Any]] = {"component": {}, "inputs": {}}
        for name, array in state.items():
            part, _, key = name.partition("/")
            parts[part][key] = array
        self.component.load(parts["component"])
        self.inputs.load(parts["inputs"])

    def _keep(self, _: Message) -> Answer:
        self._kept = self.state()
        return {}, {}

    def _rewind(self, _: Message) -> Answer:
        self.restore(self._kept)
        return {}, {}

    def _save(self, _: Message) -> Answer:
        return {}, self.state()

    def _load(self, message: Message) -> Answer:
        self.restore(message.fields)
        return {}, {}

    def _view(self, message: Message) -> Answer:
        return {"totals": self._totals()}, self.component.view()


def peak_memory() -> int:
    """Largest resident memory of this process so far [bytes]."""
    with open("/proc/self/status") as status:
        return next(1024 * int(line.split()[1]) for line in status if line.startswith("VmHWM"))


def failure(error: BaseException) -> dict[str, Any]:
    """Put an error into the header that tells the coupler of it."""
    own = isinstance(error, QuintetError)
    return {
        "order": "failed",
        "error": type(error).__name__,
        "text": str(error),
        "traceback": "" if own else "".join(traceback.format_exception(error)),
    }


def answer(server: Server, line: Line, message: Message) -> bool:
    """Handle one order and send the answer; tell whether to go on."""
    try:
        header, fields = server.handle(message)
    except Exception as error:
        if not isinstance(error, QuintetError):
            traceback.print_exc()  # into the component's log, before the coupler looks there
        line.send(failure(error), {})
        return False
    line.send({"order": "done", **header}, fields)
    return message.order != "finish"


def serve(server: Server, line: Line) -> bool:
    """Answer the coupler until it says finish; tell whether all went well."""
    while True:
        message = line.receive(PATIENCE)
        if message.order == "abort":
            return False
        if not answer(server, line, message):
            return message.order == "finish"
