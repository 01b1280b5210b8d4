"""Which disturbances a seed chooses for a scene, and where in the run they come.

A place is an order to a component: that of the first window after a share of the simulated time,
or one of the orders before and after all windows. No clock is read, so that a seed chooses the
same places again, however fast the machine is.
"""

import math
import random
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

PROCESSES = ("kill", "stop", "slow")
FRAMES = ("drop", "duplicate", "corrupt")
EVERYWHERE = ("delay", "full disk")
# Over MPI and memory no message is disturbed: nobody sends it again, and no socket carries it.
# Over memory there are no processes but the run's own.
KINDS = {
    "zenoh": (*PROCESSES, *FRAMES, *EVERYWHERE),
    "mpi": (*PROCESSES, *EVERYWHERE),
    "memory": EVERYWHERE,
}
BEFORE, DURING, AFTER = "before", "during", "after"
ORDERS = ("go", "describe", "bind", "prepare", "give", "view", "conclude", "finish")
TIMED = ("advance", "view")  # come again and again
IN_WINDOWS = 0.75  # share of the disturbances that come in a window
MOST = 4  # disturbances of a run
DELAY = (0.01, 0.5)  # s
STOPPED = (0.02, 0.4)  # s
SLOWED = (0.1, 0.6)  # s


@dataclass(frozen=True, slots=True)
class Fault:
    """One disturbance.

    Parameters
    ----------
    kind : str
        One of `KINDS`.
    component : str
        "" of the disk.
    order : str
        To the component, with which it comes.
    share : float, 1
        Of the simulated time of the run, from which on the order counts.
    moment : {"before", "during", "after"}
        Of a process or a delay: before the order, while it is carried out, or after its answer.
        Of a message: the order (before) or its answer (after).
    rank : int
        Of the process; -1: the only one.
    amount : float
        Copies of a message, pieces of files, place of a bit as a share of the message, or share of
        the usual time of the order that passes before a process is met.
    seconds : float, s
        That it lasts; inf: for good.
    """

    kind: str
    component: str = ""
    order: str = "advance"
    share: float = 0.0
    moment: str = BEFORE
    rank: int = -1
    amount: float = 0.0
    seconds: float = 0.0

    def __str__(self) -> str:
        if self.kind == "full disk":
            return f"{self._place()}: the disk is full for {self.amount:.0f} piece(s) of files"
        return f"{self._place()}: {self._what()}"

    def _place(self) -> str:
        share = f"from {100.0 * self.share:.1f} % of the run on"
        if self.kind == "full disk":
            return share
        order = f"order {self.order} to {self.component}"
        return f"first {order} {share}" if self.order in TIMED else order

    def _what(self) -> str:
        message = "the order" if self.moment == BEFORE else "its answer"
        process = f"rank {self.rank}" if self.rank >= 0 else "its process"
        when = {
            BEFORE: "before it",
            DURING: f"{100.0 * self.amount:.0f} % of the usual time after it",
            AFTER: "after its answer",
        }[self.moment]
        match self.kind:
            case "kill":
                return f"{process} is killed {when}"
            case "stop":
                ends = "for good" if self.seconds == math.inf else f"for {self.seconds:.2f} s"
                return f"{process} is stopped {ends} {when}"
            case "slow":
                return f"{process} is slowed down for {self.seconds:.2f} s {when}"
            case "delay":
                return f"{message} is delayed by {self.seconds:.2f} s"
            case "drop":
                return f"{message} is dropped"
            case "duplicate":
                return f"{message} arrives {self.amount:.0f} times"
            case _:
                return f"a bit of {message} is flipped, {100.0 * self.amount:.0f} % into it"


def choose(
    seed: int, transport: str, ranks: Mapping[str, int], elsewhere: Iterable[str] = ()
) -> list[Fault]:
    """Choose the disturbances of a run.

    Parameters
    ----------
    ranks : mapping
        Number of processes of each component, by its name.
    elsewhere : iterable of str
        Names of those whose processes the run does not start, and does not disturb.
    """
    draw, theirs = random.Random(f"chaos {seed}"), set(elsewhere)
    return [_draw(draw, transport, ranks, theirs) for _ in range(draw.randint(1, MOST))]


def _draw(
    draw: random.Random, transport: str, ranks: Mapping[str, int], elsewhere: set[str]
) -> Fault:
    component = draw.choice(sorted(ranks))
    kinds = [
        kind for kind in KINDS[transport] if component not in elsewhere or kind not in PROCESSES
    ]
    kind, share = draw.choice(kinds), draw.random()
    if kind == "full disk":
        return Fault(kind, share=share, amount=float(draw.randint(1, 4)))
    order = "advance" if draw.random() < IN_WINDOWS else draw.choice(ORDERS)
    several = ranks[component] > 1
    rank, place, copies = draw.randrange(ranks[component]), draw.random(), draw.randint(2, 3)
    moment = draw.choice((BEFORE, DURING, AFTER) if kind in PROCESSES else (BEFORE, AFTER))
    seconds = {
        "delay": draw.uniform(*DELAY),
        "stop": draw.choice((math.inf, draw.uniform(*STOPPED))),
        "slow": draw.uniform(*SLOWED),
    }
    return Fault(
        kind,
        component,
        order,
        share if order in TIMED else 0.0,
        moment,
        rank if several and kind in PROCESSES else -1,
        float(copies) if kind == "duplicate" else place,
        seconds.get(kind, 0.0),
    )
