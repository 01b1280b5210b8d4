"""The disturbances of one run: planned, told, carried out, reported."""

import dataclasses
import sys
from collections.abc import Callable
from typing import Any

from quintet.coupler.chaos.disturbed_line import DisturbedLine
from quintet.coupler.chaos.full_disk import FullDisk
from quintet.coupler.chaos.plan import KINDS, Fault, choose
from quintet.coupler.chaos.processes import Signals
from quintet.coupler.scene.scene import Scene
from quintet.interfaces.lines.transport import WatchedLine

LEFT_OUT = {
    "zenoh": "",
    "mpi": "; over mpi no message is dropped, duplicated or corrupted, and no process is replaced",
    "memory": "; over memory messages are delayed and the disk is full, nothing else",
}


class Chaos:
    """Disturbs a run as the seed of its scene says; see `Disturbance`.

    Where the scene gives no restarts, it gets as many as there are disturbances, over zenoh.
    """

    def __init__(self, scene: Scene) -> None:
        assert scene.chaos is not None
        self.seed, self._end = scene.chaos, scene.file.end
        ranks = {name: plan.ranks for name, plan in scene.components.items()}
        self._planned = choose(self.seed, scene.transport, ranks, scene.elsewhere)
        self._pending, self._happened = list(self._planned), list[str]()
        self._began, self._now = 0.0, -1.0  # s, simulated; below 0 before the first window
        self._signals, self._disk = Signals(), FullDisk(self._note)
        self._wires: dict[str, Any] = {}
        restarts = ""
        if scene.transport == "zenoh" and not scene.file.restarts:
            scene.file = dataclasses.replace(scene.file, restarts=len(self._planned))
            restarts = f"; restarts = {len(self._planned)}, as the scene gives none"
        kinds = ", ".join(KINDS[scene.transport])
        lines = [f"  {number}. {fault}" for number, fault in enumerate(self._planned, 1)]
        self._say(
            f"{len(self._planned)} disturbance(s) on purpose, of {kinds}"
            f"{LEFT_OUT[scene.transport]}{restarts}\n" + "\n".join(lines)
        )

    def line(self, name: str, line: WatchedLine, pids: Callable[[], list[int]]) -> WatchedLine:
        """See `Disturbance.line`."""
        return DisturbedLine(
            line,
            lambda order, window: self._next_fault(name, order, window),
            pids,
            self._signals,
            lambda fault: self._wires[name].disturb(fault),
        )

    def wire(self, name: str, line: Any) -> None:
        """See `Disturbance.wire`."""
        # Only runs over zenoh load it.
        from quintet.coupler.chaos.wire import Wire

        self._wires.setdefault(name, Wire()).attach(line)

    def noting(self, note: Callable[[int, float], None]) -> Callable[[int, float], None]:
        """See `Disturbance.noting`."""

        def note_both(windows: int, time: float) -> None:
            note(windows, time)
            if self._now < 0.0:
                self._began = time
            self._now = time
            for fault in [fault for fault in self._pending if not fault.component]:
                if self._share() >= fault.share:
                    self._pending.remove(fault)
                    self._disk.fill(int(fault.amount))

        return note_both

    def remark(self) -> str:
        """See `Disturbance.remark`."""
        happened = "; ".join(self._happened) or "nothing yet"
        return f" The run is disturbed on purpose (--chaos {self.seed}): {happened}."

    def summary(self) -> dict[str, Any]:
        """See `Disturbance.summary`."""
        planned = [str(fault) for fault in self._planned]
        about = {"seed": self.seed, "planned": planned, "happened": self._happened}
        return {"chaos": about}

    def close(self) -> None:
        """See `Disturbance.close`."""
        self._signals.close()
        self._disk.close()

    def _share(self) -> float:
        """Share of the simulated time that is over; below 0 before the first window."""
        left = self._end - self._began
        return (self._now - self._began) / left if self._now >= 0.0 and left else self._now

    def _next_fault(self, name: str, order: str, window: int) -> Fault | None:
        for fault in self._pending:
            if (fault.component, fault.order) != (name, order):
                continue
            if fault.share <= max(self._share(), 0.0):
                self._pending.remove(fault)
                self._note(f"window {window} of {name}, {fault}")
                return fault
        return None

    def _note(self, text: str) -> None:
        place = f"t = {self._now:.6g} s, " if self._now >= 0.0 else ""
        self._happened.append(place + text)
        self._say(place + text)

    def _say(self, text: str) -> None:
        print(f"\nquintet: chaos {self.seed}: {text}", file=sys.stderr, flush=True)
