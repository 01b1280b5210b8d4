"""Lines within one process: the component runs in that of the coupler."""

from collections import deque
from collections.abc import Callable

from quintet.interfaces.errors import LineError
from quintet.interfaces.lines.message import Frame, Message
from quintet.interfaces.lines.transport import FramedLine


class MemoryLine(FramedLine):
    """The coupler's end; a message is handled when it is sent, its answer queued.

    Messages are packed and checked as on any other line: a scene that runs here runs there.
    """

    def __init__(self, run: str, name: str) -> None:
        super().__init__(run, name)
        self.handle: Callable[[Message], object] = lambda message: None  # executes an order
        self.far = _FarEnd(run, name)

    def _put(self, frame: bytearray) -> None:
        self.far.inbox.append(frame)
        self._scratch = None  # the receiver's arrays are views of this frame
        self.handle(self.far.receive(0.0))

    def _poll(self) -> Frame | None:
        return self.far.outbox.popleft() if self.far.outbox else None

    def _broken(self) -> str:
        return "the component gave no answer"

    def close(self) -> None:
        """See `Line.close`."""


class _FarEnd(FramedLine):
    """The component's end."""

    def __init__(self, run: str, name: str) -> None:
        super().__init__(run, name)
        self.inbox: deque[Frame] = deque()
        self.outbox: deque[Frame] = deque()

    def _put(self, frame: bytearray) -> None:
        self.outbox.append(frame)
        self._scratch = None

    def _poll(self) -> Frame | None:
        if not self.inbox:
            raise LineError("no order is waiting")
        return self.inbox.popleft()

    def _broken(self) -> str:
        return ""

    def close(self) -> None:
        """See `Line.close`."""
