"""A line to a component on another host, which the network may hold up at any time."""

import contextlib
import threading
import time

import zenoh

from quintet.interfaces.errors import LineError
from quintet.interfaces.lines.transport import wait
from quintet.interfaces.lines.zenoh import ZenohLine

ROOM = 1 << 15  # bytes that the queues of a connection always take
LONGEST = 86400.0  # s; who watches the line ends the wait


class LineElsewhere(ZenohLine):
    """A line that can be given up while it sends.

    zenoh blocks in `put` while a connection takes no more, as after a cut, and cannot be
    interrupted. A thread waits in the place of the caller then, for as long as it takes.
    """

    _busy = False  # a thread still sends

    def _put(self, frame: bytearray) -> None:
        if self._busy:
            raise LineError(f"cannot send to {self.other}: the message before is still on its way")
        if len(frame) <= ROOM:
            super()._put(frame)
            return
        ends: list[LineError | bool] = []
        self._busy = True
        threading.Thread(target=self._put_into, args=(frame, ends), daemon=True).start()
        end = wait(lambda: ends[0] if ends else None, LONGEST, self._reason)
        self._busy = False
        self._repeat_at = time.monotonic() + self._pause  # the answer is awaited from now on
        if isinstance(end, LineError):
            raise end

    def _repeat(self) -> None:
        """See `FramedLine._repeat`; a message that is still on its way is not sent again."""
        if not self._busy:
            super()._repeat()

    def _put_into(self, frame: bytearray, ends: list[LineError | bool]) -> None:
        try:
            super()._put(frame)
            ends.append(True)
        except LineError as error:
            ends.append(error)

    def _undeclare(self) -> None:
        with contextlib.suppress(zenoh.ZError, RuntimeError):  # while it sends
            super()._undeclare()
