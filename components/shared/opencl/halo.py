"""Copies of the rows of other ranks on a device, brought up to date through the host.

A solver of several ranks has such copies among its rows. Rows that others need are packed on the
device and copied to the host, which exchanges them as `shared/domain/halo.py` does; what
arrives is copied to the device and unpacked there.
"""

from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.domain.halo import Halo
from quintet.components.shared.opencl.arrays import DeviceArray
from quintet.components.shared.opencl.devices import opencl
from quintet.components.shared.opencl.launches import Launch
from quintet.interfaces.component import Array

SOURCE = Path(__file__).with_name("halo.cl")
WORD = 8  # bytes
Whole = NDArray[np.int64]


def source() -> str:
    """Return the kernels, for a program of either precision."""
    return SOURCE.read_text()


class Messages(NamedTuple):
    """Room for rows of some arrays that are sent and received, and kernels that copy them."""

    sent: DeviceArray  # (sent, words) words
    received: DeviceArray  # (copies, words) words
    staged: Array  # (sent + copies, words) words, both on the host
    halo: Halo  # of these
    packs: list[Launch]  # of each array
    unpacks: list[Launch]


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
        self._kernel = partial(opencl().Kernel, kernels)
        self.count = 0  # copies
        self._sent_count = 0
        self._messages: dict[tuple[DeviceArray, ...], Messages] = {}

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

    def release(self) -> None:
        """Forget the arrays that were exchanged, so that their memory can be freed."""
        self._messages = {}

    def clear(self) -> None:
        """Drop the copies."""
        self._sent_count, self.count, self._messages = 0, 0, {}

    def _rows(self, of_ranks: list[Whole]) -> DeviceArray:
        """Rows of all ranks, on the device."""
        return DeviceArray.of(self.queue, np.concatenate(of_ranks).astype(np.int32))

    def exchange(self, *arrays: DeviceArray) -> None:
        """Bring the copies in arrays (rows, ...) up to date.

        Their rows have whole words of 8 bytes. The same arrays are exchanged again and again.
        """
        if not (self.count or self._sent_count):
            return
        if arrays not in self._messages:
            self._messages[arrays] = self._prepared(arrays)
        messages, sent = self._messages[arrays], self._sent_count
        for pack in messages.packs:
            pack.run()
        messages.staged[:sent] = messages.sent.get()
        messages.halo.exchange(messages.staged)
        messages.received.put(messages.staged[sent:])
        for unpack in messages.unpacks:
            unpack.run()

    def _prepared(self, arrays: tuple[DeviceArray, ...]) -> Messages:
        """Make room for rows of some arrays, and their kernels."""
        widths = [_words(array) for array in arrays]
        words, sent, copies = sum(widths), self._sent_count, self.count
        of_sent, of_copies = (DeviceArray(self.queue, (rows, words)) for rows in (sent, copies))
        numbers = [
            tuple(map(np.int32, (width, word, words)))
            for width, word in zip(widths, np.cumsum([0, *widths]), strict=False)
        ]
        packs, unpacks = [], []
        for array, places in zip(arrays, numbers, strict=True):
            packed = self._sent_row, np.int32(sent), *places, array, of_sent
            unpacked = self._received_row, np.int32(copies), *places, of_copies, array
            packs.append(Launch(self.queue, self._kernel("pack"), sent, *packed))
            unpacks.append(Launch(self.queue, self._kernel("unpack"), copies, *unpacked))
        rows = self._staged_sent, self._staged_received
        halo = Halo(self._communicator, *rows, [words])
        return Messages(of_sent, of_copies, np.empty((sent + copies, words)), halo, packs, unpacks)


def _staged(of_ranks: list[Whole], first: int) -> list[Whole]:
    """Rows of a message, rank after rank, starting at row `first`."""
    ends = first + np.cumsum([0, *map(len, of_ranks)])
    return [np.arange(begin, end) for begin, end in pairwise(ends.tolist())]


def _words(array: DeviceArray) -> int:
    """Words in a row of an array."""
    return int(np.prod(array.shape[1:])) * array.dtype.itemsize // WORD
