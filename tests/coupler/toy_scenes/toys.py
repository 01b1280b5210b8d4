"""Components for trying out the coupler: they swap numbers, and fail on purpose."""

import os
import signal
import sys
import time
from typing import Literal

import numpy as np

from quintet.interfaces.component import Component, Field, Port, Totals
from quintet.interfaces.errors import PortError
from quintet.interfaces.manifest import BenchCase, Manifest
from quintet.interfaces.params import Count, parameters

NUMBER = (Field("number", (3,), "m"), Field("push", (3,), "N", "impulse"))


class Toy(Component):
    """Gives the number it takes, slightly changed."""

    @parameters
    class Params:
        items: Count = 5
        pause: float = 0.0  # s, of every step
        substeps: Count = 1  # of a window of 1 ms
        seen: bool = False  # whether it has a view
        talks: bool = False  # whether it prints a line at every step
        fails_at: int = -1
        fails_by: Literal["raise", "long", "odd", "sys.exit", "kill"] = "raise"

    takes = (Port("in", NUMBER),)
    gives = (Port("out", NUMBER),)

    def __init__(self, params):
        self.params = params
        self.value = np.linspace(0.0, 1.0, 3 * params.items).reshape(-1, 3)
        self.push, self.pushed = np.zeros_like(self.value), np.zeros((1, 3))
        self.partner = np.zeros((0, 3))  # none yet
        self.steps, self.time = 0, 0.0

    def stable_dt(self):
        return 1e-3 / self.params.substeps

    def take(self, fields):
        if any(field.shape != self.value.shape for field in fields.values()):
            raise PortError(f"a toy takes fields of shape {self.value.shape} only")
        self.partner = np.array(fields.get("in.number", self.partner))
        self.pushed = np.array(fields.get("in.push", self.pushed))

    def step(self, dt):
        time.sleep(self.params.pause)
        if self.params.talks:
            print("a step", flush=True)
        pull = 100.0 * (self.partner - self.value) if len(self.partner) else 0.0
        self.value = self.value + dt * (pull + self.pushed)
        if self.steps == self.params.fails_at:
            self.fail()
        self.push = np.sin(self.value + 10.0 * self.time)
        self.steps, self.time = self.steps + 1, self.time + dt
        if self.steps == 50:
            print("step 50", flush=True)

    def fail(self):
        match self.params.fails_by:
            case "raise":
                raise ArithmeticError("asked to raise")
            case "long":
                raise ArithmeticError("asked to say much " + 200_000 * "and more " + "to the end")
            case "odd":
                raise ArithmeticError("asked to say \udcff")
            case "sys.exit":
                sys.exit(0)
            case "kill":
                os.kill(os.getpid(), signal.SIGKILL)

    def give(self, wanted):
        return {"out.number": self.value.copy(), "out.push": self.push.copy()}

    def save(self):
        state = {"value": self.value, "push": self.push, "steps": np.array(self.steps)}
        inputs = {"partner": self.partner, "pushed": self.pushed, "time": np.array(self.time)}
        return {name: array.copy() for name, array in (state | inputs).items()}

    def load(self, state):
        shape = self.value.shape
        self.value = np.array(state["value"], float).reshape(shape)
        self.push = np.array(state["push"], float).reshape(shape)
        self.partner = np.array(state["partner"], float).reshape(-1, 3)
        self.pushed = np.array(state["pushed"], float).reshape(-1, 3)
        self.steps, self.time = int(state["steps"]), float(state["time"])

    def totals(self):
        return Totals(mass=1.0)

    def view(self):
        return {"points": self.value.copy()} if self.params.seen else {}

    def items(self):
        return self.params.items


def cases():
    return (
        BenchCase("small", {"items": 7, "pause": 0.005}, 3, 20, "toy-steps/s"),
        BenchCase("large", {"items": 1_000_000}, 2, 2, "toy-steps/s"),
    )


COUNTED = Manifest(
    "toys:COUNTED", "A toy to be measured", Toy.Params, "toys:Toy",
    lambda _: (Toy.takes, Toy.gives), bench="toys:cases",
)  # fmt: skip


class Plain:
    """No component at all."""

    @parameters
    class Params:
        pass


class Bare(Component):
    """A component without parameters of its own."""

    stable_dt = take = step = give = save = load = lambda self, *_: None


def misfit(name, field):
    """A toy whose field differs."""
    ports = {"takes": (Port("in", (field,)),), "gives": (Port("out", (field,)),)}
    return type(name, (Toy,), {**ports, "__doc__": "A toy that does not fit."})


InSeconds = misfit("InSeconds", Field("number", (3,), "s"))
Impulsive = misfit("Impulsive", Field("number", (3,), "m/s", "impulse"))
Instant = misfit("Instant", Field("push", (3,), "N"))
Scalar = misfit("Scalar", Field("number", (), "m"))
Unknown = misfit("Unknown", Field("heat", (3,), "m"))


class Fragile(Toy):
    """Cannot be built."""

    def __init__(self, params):
        raise RuntimeError("asked not to be built")
