"""A line to a component that is disturbed when orders go out and answers come back."""

import time
from collections.abc import Callable, Mapping
from typing import Any

from quintet.coupler.chaos.plan import AFTER, BEFORE, DURING, FRAMES, Fault
from quintet.coupler.chaos.processes import Signals
from quintet.interfaces.component import Fields
from quintet.interfaces.lines.message import Frame, Message, Shapes
from quintet.interfaces.lines.transport import WatchedLine

NextFault = Callable[[str, int], Fault | None]  # of an order, in a window of the component


class DisturbedLine:
    """The line of a component, with its disturbances.

    Parameters
    ----------
    line : WatchedLine
        That is disturbed.
    next_fault : function
        Returns what comes with an order.
    pids : function
        Returns the processes of the component.
    signals : Signals
        To them.
    disturb_message : function
        Disturbs the next order, or the answer to it.
    """

    def __init__(
        self,
        line: WatchedLine,
        next_fault: NextFault,
        pids: Callable[[], list[int]],
        signals: Signals,
        disturb_message: Callable[[Fault], None],
    ) -> None:
        self._line, self._next_fault, self._pids = line, next_fault, pids
        self._signals, self._disturb_message = signals, disturb_message
        self._fault: Fault | None = None  # of the order under way
        self._sent_at, self._usual = 0.0, 0.0  # s

    @property
    def watch(self) -> Callable[[], str]:
        """See `WatchedLine.watch`."""
        return self._line.watch

    @watch.setter
    def watch(self, watch: Callable[[], str]) -> None:
        self._line.watch = watch

    def send(self, header: Mapping[str, Any], fields: Fields) -> None:
        """See `Line.send`."""
        self._fault = fault = self._next_fault(str(header["order"]), int(header.get("window", 0)))
        self._act(BEFORE)
        self._sent_at = time.monotonic()
        self._line.send(header, fields)
        if fault and fault.moment == DURING:
            time.sleep(fault.amount * self._usual)
            self._act(DURING)

    def receive(self, seconds: float, expected: Shapes | None = None) -> Message:
        """See `Line.receive`."""
        message = self._line.receive(seconds, expected)
        if not self._fault:
            self._usual = time.monotonic() - self._sent_at
        self._act(AFTER)
        self._fault = None
        return message

    def peek(self) -> Frame | None:
        """See `WatchedLine.peek`."""
        return self._line.peek()

    def close(self) -> None:
        """See `Line.close`."""
        self._line.close()

    def _act(self, moment: str) -> None:
        fault = self._fault
        if fault and fault.kind in FRAMES and moment == BEFORE:
            self._disturb_message(fault)
        elif fault and fault.kind == "delay" and fault.moment == moment:
            time.sleep(fault.seconds)
        elif fault and fault.moment == moment and (pids := self._pids()):
            pid = pids[max(fault.rank, 0) % len(pids)]
            match fault.kind:
                case "kill":
                    self._signals.kill(pid)
                case "stop":
                    self._signals.stop(pid, fault.seconds)
                case "slow":
                    self._signals.slow(pid, fault.seconds)
