"""Listed pairs of balls in the memory of a device, with the history of their contacts."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.dem_bodies.kernels.rolling_resistance import rolling_constants
from quintet.components.dem_bodies.opencl.programs import WIDTH
from quintet.components.dem_bodies.state import BallPairs, Model, Numbers
from quintet.components.shared.opencl.arrays import DeviceArray


class DevicePairs:
    """Pairs in the host's order, and which of them list each row.

    Parameters
    ----------
    queue : pyopencl.CommandQueue
    model : Model
    balls : BallPairs
        Of the host, with their history.
    lanes : int
        How many pairs are computed at once: arrays that are written have room for so many more.
    """

    def __init__(self, queue: Any, model: Model, balls: BallPairs, lanes: int) -> None:
        self.count, self.balls = len(balls.partner), balls
        self.stride = -(-self.count // lanes) * lanes
        rows, numbers = len(balls.begin) - 1, ("begin", "row", "partner", "constants_row")
        self.begin, self.row, self.partner, self.constants_row = (
            whole_numbers(queue, getattr(balls, name)) for name in numbers
        )
        self.constants = DeviceArray.of(queue, constants_of(model, balls))
        to_ball = np.flatnonzero(balls.partner < rows)
        listed = balls.partner[to_ball]
        ends = np.cumsum(np.bincount(listed, minlength=rows))
        self.incoming = whole_numbers(queue, to_ball[np.argsort(listed, kind="stable")])
        self.incoming_begin = whole_numbers(queue, np.concatenate([[0], ends]))
        self.history = DeviceArray.of(queue, self._with_room(balls.history.T).T)
        self.push = DeviceArray(queue, (2 * self.stride, 4))
        self.spring = self.moment = None
        if balls.rolling_moment is not None:
            self.spring = DeviceArray.of(queue, self._with_room(balls.rolling_moment, 4))
            self.moment = DeviceArray(queue, (self.stride, 4))

    def _with_room(self, rows: Numbers, width: int | None = None) -> Numbers:
        """Rows (pairs, k), with room for all lanes, and up to a width."""
        count, columns = rows.shape
        padded = np.zeros((self.stride, width or columns))
        padded[:count, :columns] = rows
        return padded

    def get(self) -> None:
        """Copy history and forces into the host's pairs."""
        balls, count = self.balls, self.count
        balls.history[:] = self.history.get()[:, :count]
        if balls.rolling_moment is not None and self.spring is not None:
            balls.rolling_moment[:] = self.spring.get()[:count, :3]
        if len(balls.force):
            balls.force[:] = self.push.get()[: 2 * count : 2, :3]


def whole_numbers(queue: Any, array: NDArray[Any]) -> DeviceArray:
    """Copy whole numbers to the device, where they have 32 bits."""
    return DeviceArray.of(queue, array.astype(np.int32))


def constants_of(model: Model, balls: BallPairs) -> Numbers:
    """Constants (kinds of pairs, 4 WIDTH) of contact, and behind them those of rolling."""
    constants = np.zeros((len(balls.constants), 4 * WIDTH))
    constants[:, :7] = balls.constants
    if balls.rolling_moment is not None:
        _, some = np.unique(balls.constants_row, return_index=True)
        constants[:, 7:9] = rolling_constants(model, balls.row[some], balls.partner[some])
    return constants
