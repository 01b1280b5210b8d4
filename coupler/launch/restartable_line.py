"""A line that outlasts the process of its component: where one dies, another takes over.

The coupler does not notice: it sends orders and receives answers. When the process has died, the
line starts another, repeats to it the orders since the last saved state, checks that it answers
with the same bits, and hands on the answer that the coupler waits for.
"""

import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeVar

from quintet.coupler.coupling.participant import LONGEST_WAIT
from quintet.coupler.launch.component_process import ComponentProcess
from quintet.coupler.launch.order_log import Entry, OrderLog
from quintet.coupler.launch.process_probe import ProcessProbe
from quintet.coupler.launch.restarts import Restarts
from quintet.coupler.launch.watchdog import say
from quintet.interfaces.component import Fields
from quintet.interfaces.errors import LineError, LostMessage
from quintet.interfaces.lines.message import Frame, Message, Shapes

T = TypeVar("T")

BUILDS = frozenset(("go", "describe", "prepare"))  # orders in which a component is built


class ReplayError(LineError):
    """A process that is to take over does not do what the one before it did."""


class RestartableLine:
    """A line to a component whose process may be replaced.

    Parameters
    ----------
    name : str
        Of the component.
    restarts : Restarts
        How often; counted here.
    begin : function
        Starts a process, or awaits one elsewhere.
    identify : function
        Checks the first message of a process, and lets its probe find it.
    folder : path
        For files of orders.
    """

    def __init__(
        self,
        name: str,
        restarts: Restarts,
        begin: Callable[[], ComponentProcess],
        identify: Callable[[Message, ProcessProbe], None],
        folder: Path,
    ) -> None:
        self.name, self.restarts = name, restarts
        self.watch: Callable[[], str] = lambda: ""  # see `FramedLine`
        self.on_replay: Callable[[bool], None] = lambda built: None  # called with every order
        self.on_return: Callable[[str], None] = lambda note: None  # called when it goes on
        self._begin, self._identify = begin, identify
        self._log = OrderLog(folder)
        self._process = self._begin_process()
        self._lost = ""  # why its process is gone, while no other has taken over

    def wait_for_partner(self, seconds: float) -> None:
        """See `ZenohLine.wait_for_partner`."""
        self._with_restarts(lambda: self._process.line.wait_for_partner(seconds))

    def send(self, header: Mapping[str, Any], fields: Fields) -> None:
        """See `Line.send`; if the process has died, that is noticed when the answer is awaited."""
        self._log.add(header, fields)
        try:
            self._process.line.send(header, fields)
        except LineError:
            if not self._process.is_over():
                raise

    def receive(self, seconds: float, expected: Shapes | None = None) -> Message:
        """See `Line.receive`."""
        message = self._with_restarts(lambda: self._process.line.receive(seconds, expected))
        self._log.answered(message)
        return message

    def peek(self) -> Frame | None:
        """See `FramedLine.peek`."""
        return self._process.line.peek()

    def close(self) -> None:
        """See `Line.close`."""
        self._log.close()
        self._process.line.close()

    def _begin_process(self) -> ComponentProcess:
        process = self._begin()
        process.line.watch = lambda: self.watch()
        return process

    def _with_restarts(self, act: Callable[[], T]) -> T:
        """Do something with the line, if need be with another process."""
        while True:
            try:
                if self._lost:
                    self._take_over()
                return act()
            except LineError as error:
                self._lose(error)

    def _lose(self, error: LineError) -> None:
        """Note that the process has died; raise what is no death, and one too many."""
        died = isinstance(error, LostMessage) or self._process.is_over()
        if isinstance(error, ReplayError) or not died:
            cause = f"{self._lost}; no other process took over: {error}"
            raise LineError(cause) if self._lost else error
        self._lost = str(error)
        if not self.restarts.left:
            raise LineError(self._lost + self.restarts.remark()) from error
        self._process.end()
        self.restarts.used += 1
        number = f"restart {self.restarts.used} of {self.restarts.limit}"
        begun = "awaited" if self._process.probe.by_hand else "started"
        say(f"{self.name}: {self._lost}; it is {begun} again ({number})")

    def _take_over(self) -> None:
        """Bring another process to where the one before it died."""
        began = time.monotonic()
        self.on_replay(False)
        self._process = process = self._begin_process()
        process.line.wait_for_partner(process.joining)
        if self._log.begun:  # else the first message is still awaited
            self._identify(process.line.receive(process.joining), process.probe)
        windows = sum(self._repeat(entry) for entry in self._log)
        cause, self._lost = self._lost, ""
        note = (
            f"{cause}; another process took over after {time.monotonic() - began:.1f} s and "
            f"repeated {windows} window(s) with the same bits"
        )
        say(f"{self.name} goes on: {note}")
        self.on_return(note)

    def _repeat(self, entry: Entry) -> bool:
        """Send an order again and compare the answer; tell whether it was a window."""
        order, line = entry.order, self._process.line
        self.on_replay(order.order not in BUILDS)
        line.send(order.header, order.fields)
        if entry.answer is None:
            return False
        if difference := entry.answer.difference(line.receive(LONGEST_WAIT)):
            place = f"window {order.header.get('window', 0)}, order {order.order}"
            raise ReplayError(
                f"it must repeat what the one before it did; {place}: {difference}. Find out on "
                "what but its inputs the component depends, or resume the run."
            )
        return order.order == "advance" and not order.header.get("trial", False)
