"""Copies of the rows of other ranks on a device, brought up to date through the host.

A solver of several ranks has such copies among its rows. Rows that others need are packed on the
device and copied to the host, which exchanges them as `shared/domain/halo.py` does; what
arrives is copied to the device and unpacked there.
"""

from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.domain.halo import Halo
from quintet.components.shared.opencl.arrays import DeviceArray, run
from quintet.components.shared.opencl.devices import opencl
from quintet.interfaces.component import Array

SOURCE = Path(__file__).with_name("halo.cl")
WORD = 8  # bytes
Whole = NDArray[np.int64]


def source() -> str:
    """Return the kernels, for a program of either precision."""
    return SOURCE.read_text()


class Messages(NamedTuple):
    """Room for the rows that are sent, and those that are received, of so many words."""

    sent: DeviceArray  # (sent, words) words
    received: DeviceArray  # (copies, words) words
    staged: Array  # (sent + copies, words) words, both on the host
    halo: Halo  # of these


class DeviceHalo:
    """Copies among the rows of one rank.

    Parameters
    ----------
    communicator : mpi4py communicator
    queue : pyopencl.CommandQueue
    kernels : pyopencl.Program
        Built from a text that has `source`.
    """

    def __init__(self, communicator: Any, queue: Any, kernels: Any) -> None:
        self._communicator, self.queue = communicator, queue
        self._pack, self._unpack = (opencl().Kernel(kernels, name) for name in ("pack", "unpack"))
        self.count = 0  # copies
        self._sent_count = 0
        self._messages: dict[int, Messages] = {}  # by the words of a row

    def follow(self, sent: list[Whole], received: list[Whole]) -> None:
        """Follow new copies.

        Parameters
        ----------
        sent : list of (k,) int array
            For each rank, the rows that it gets.
        received : list of (m,) int array
            For each rank, the rows into which its rows go.
        """
        self._sent_count, self.count = sum(map(len, sent)), sum(map(len, received))
        self._sent_row, self._received_row = map(self._rows, (sent, received))
        self._staged_sent, self._staged_received = (
            _staged(sent, 0),
            _staged(received, self._sent_count),
        )
        self._messages = {}

    def _rows(self, of_ranks: list[Whole]) -> DeviceArray:
        """Rows of all ranks, on the device."""
        return DeviceArray.of(self.queue, np.concatenate(of_ranks).astype(np.int32))

    def exchange(self, *arrays: DeviceArray) -> None:
        """Bring the copies in arrays (rows, ...) up to date.

        Their rows have whole words of 8 bytes.
        """
        if not (self.count or self._sent_count):
            return
        widths = [_words(array) for array in arrays]
        messages = self._of_words(sum(widths))
        numbers = [
            tuple(map(np.int32, (width, word, sum(widths))))
            for width, word in zip(widths, np.cumsum([0, *widths]), strict=False)
        ]
        sent, copies = self._sent_count, self.count
        for array, words in zip(arrays, numbers, strict=True):
            count = np.int32(sent)
            run(self.queue, self._pack, sent, self._sent_row, count, *words, array, messages.sent)
        messages.staged[:sent] = messages.sent.get()
        messages.halo.exchange(messages.staged)
        messages.received.put(messages.staged[sent:])
        for array, words in zip(arrays, numbers, strict=True):
            rows = self._received_row, np.int32(copies)
            run(self.queue, self._unpack, copies, *rows, *words, messages.received, array)

    def _of_words(self, words: int) -> Messages:
        """Room for rows of so many words, made when they are first exchanged."""
        if words not in self._messages:
            sent, copies = self._sent_count, self.count
            rows = self._staged_sent, self._staged_received
            self._messages[words] = Messages(
                DeviceArray(self.queue, (sent, words)),
                DeviceArray(self.queue, (copies, words)),
                np.empty((sent + copies, words)),
                Halo(self._communicator, *rows, [words]),
            )
        return self._messages[words]


def _staged(of_ranks: list[Whole], first: int) -> list[Whole]:
    """Rows of a message in which those of each rank stand one after another, from one on."""
    ends = first + np.cumsum([0, *map(len, of_ranks)])
    return [np.arange(begin, end) for begin, end in pairwise(ends.tolist())]


def _words(array: DeviceArray) -> int:
    """Words in a row of an array."""
    return int(np.prod(array.shape[1:])) * array.dtype.itemsize // WORD
