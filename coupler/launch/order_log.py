"""The orders that brought a component to its state, for another process to repeat.

The orders before the first window are kept for the whole run; those of windows only since the
component last saved its state. A short log stays in memory, a long one is a file without a name in
the folder of the run. Of each answer the log keeps checksums.
"""

import os
import tempfile
import zlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from quintet.interfaces.component import Fields
from quintet.interfaces.lines.message import PREFIX, Message, decode, encode

IN_MEMORY = 1 << 24  # bytes of orders; more go into a file
START = frozenset(("go", "describe", "sample", "bind", "begin", "give", "prime", "prepare"))
WITHOUT_EFFECT = frozenset(("view", "save", "conclude", "finish"))  # on the state; without fields


@dataclass(frozen=True, slots=True)
class Answer:
    """What another process must answer to the same order."""

    order: str
    steps: int | None
    stable: float | None  # s
    checksums: dict[str, int]  # CRC-32 of each field

    @classmethod
    def of(cls, message: Message) -> "Answer":
        """Note what an answer says."""
        checksums = {key: zlib.crc32(array.data) for key, array in message.fields.items()}
        header = message.header
        return cls(message.order, header.get("steps"), header.get("stable"), checksums)

    def difference(self, message: Message) -> str:
        """Say in what the answer of another process differs; "" where it does not."""
        other = Answer.of(message)
        if other.order != self.order:
            text = message.header.get("text", "")
            return f"the answer was {self.order}, and is {other.order} now{': ' * bool(text)}{text}"
        for key in sorted(self.checksums.keys() | other.checksums.keys()):
            if self.checksums.get(key) != other.checksums.get(key):
                return f"{key} has other bits"
        if (self.steps, self.stable) != (other.steps, other.stable):
            was, now = f"{self.steps} of {self.stable!r} s", f"{other.steps} of {other.stable!r} s"
            return f"the steps, and the largest stable one, were {was}, and are {now} now"
        return ""


@dataclass(frozen=True, slots=True)
class Entry:
    """An order, and its answer: None where nobody answers it, or nobody has done so yet."""

    order: Message
    answer: Answer | None


class Orders:
    """Orders in a row, of which the last may not be answered yet."""

    def __init__(self, folder: Path) -> None:
        self._file = tempfile.SpooledTemporaryFile(IN_MEMORY, dir=str(folder))
        self._scratch: bytearray | None = None
        self.answers: list[Answer | None] = []

    def add(self, header: Mapping[str, Any], fields: Fields) -> None:
        """Add an order."""
        self._scratch = encode(header, fields, self._scratch)
        self._file.seek(0, os.SEEK_END)
        self._file.write(self._scratch)

    def __iter__(self) -> Iterator[Entry]:
        self._file.seek(0)
        answers = iter(self.answers)
        while prefix := self._file.read(PREFIX.size):
            rest = PREFIX.unpack(prefix)[2] - PREFIX.size
            yield Entry(decode(prefix + self._file.read(rest)), next(answers, None))

    def close(self) -> None:
        """Forget all of them."""
        self._file.close()


class OrderLog:
    """All orders that another process must repeat to come to the present state of a component.

    Parameters
    ----------
    folder : path
        Where the files of long logs lie.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._start, self._windows = Orders(folder), Orders(folder)
        self._now = self._start  # where orders are noted
        self._last: Mapping[str, Any] = {}  # header of the order that is not answered yet
        self._stable: float | None = None  # s, as last told
        self.begun = False  # whether there is any order

    def add(self, header: Mapping[str, Any], fields: Fields) -> None:
        """Note an order before it is sent."""
        order = header["order"]
        self._last, self.begun = header, True
        if order == "load":
            self._forget_windows()
        elif order not in START:
            self._now = self._windows
        if order not in WITHOUT_EFFECT:
            self._now.add(header, fields)
        if order == "go":  # which nobody answers
            self._start.answers.append(None)

    def answered(self, message: Message) -> None:
        """Note the answer to the last order; with a saved state the log of windows begins."""
        last, self._last = self._last, {}
        order = last.get("order")
        if order == "save" and message.order == "done":
            self._forget_windows()
            self._windows.add({**last, "order": "load"}, message.fields)
            self._windows.answers.append(Answer("done", None, self._stable, {}))
        elif order and order not in WITHOUT_EFFECT:
            answer = Answer.of(message)
            self._now.answers.append(answer)
            self._stable = self._stable if answer.stable is None else answer.stable

    def __iter__(self) -> Iterator[Entry]:
        yield from self._start
        yield from self._windows
        if self._last.get("order") in WITHOUT_EFFECT:
            yield Entry(Message(dict(self._last)), None)

    def close(self) -> None:
        """Forget all orders."""
        self._start.close()
        self._windows.close()

    def _forget_windows(self) -> None:
        self._windows.close()
        self._windows = self._now = Orders(self._folder)
