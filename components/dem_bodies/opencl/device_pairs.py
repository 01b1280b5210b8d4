"""Listed pairs of balls in the memory of a device, with the history of their contacts."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.dem_bodies.contact.ball_pairs import ball_pairs
from quintet.components.dem_bodies.kernels.rolling_resistance import rolling_constants
from quintet.components.dem_bodies.opencl.programs import WIDTH
from quintet.components.dem_bodies.state import BallPairs, Model, Numbers
from quintet.components.shared.opencl.arrays import DeviceArray


@dataclass(frozen=True, slots=True)
class DevicePairs:
    """`BallPairs` in device memory, and for each row the pairs in which it is the partner."""

    count: int
    stride: int  # pairs that arrays have room for
    begin: DeviceArray  # (b + 1,)
    row: DeviceArray  # (pairs,)
    partner: DeviceArray  # (pairs,)
    constants_row: DeviceArray  # (pairs,)
    constants: DeviceArray  # (kinds of pairs, 4 WIDTH), see pairs.cl
    incoming_begin: DeviceArray  # (b + 1,)
    incoming: DeviceArray  # pairs with a later ball, by its row
    history: DeviceArray  # (4, stride)
    push: DeviceArray  # (2 stride, 4) force [N] and depth [m]; force × normal [N]
    spring: DeviceArray | None  # (stride, 4) N m, elastic moment; None if no pair resists rolling
    moment: DeviceArray | None  # (stride, 4) N m, all of it

    def on_host(self, model: Model, records_forces: bool) -> BallPairs:
        """Pairs of the host without history; its rows have the order of the device's."""
        begin, partner = self.begin.get().astype(np.int64), self.partner.get().astype(np.uint32)
        return ball_pairs(model, begin, partner, records_forces)

    def get(self, balls: BallPairs) -> None:
        """Copy history and forces into the same pairs of the host."""
        balls.history[:] = self.history.get()[:, : self.count]
        if balls.rolling_moment is not None and self.spring is not None:
            balls.rolling_moment[:] = self.spring.get()[: self.count, :3]
        if len(balls.force):
            balls.force[:] = self.push.get()[: 2 * self.count : 2, :3]


def pairs_of_host(queue: Any, model: Model, balls: BallPairs, lanes: int) -> DevicePairs:
    """Copy the host's pairs with their history; `lanes` pairs per work item."""
    count, rows = len(balls.partner), len(balls.begin) - 1
    stride = -(-count // lanes) * lanes
    pairs_of_balls = np.flatnonzero(balls.partner < rows)
    partner_rows = balls.partner[pairs_of_balls]
    ends = np.cumsum(np.bincount(partner_rows, minlength=rows))
    spring = moment = None
    if balls.rolling_moment is not None:
        spring = DeviceArray.of(queue, _with_room(balls.rolling_moment, stride, 4))
        moment = DeviceArray(queue, (stride, 4))
    return DevicePairs(
        count=count,
        stride=stride,
        begin=_whole(queue, balls.begin),
        row=_whole(queue, balls.row),
        partner=_whole(queue, balls.partner),
        constants_row=_whole(queue, balls.constants_row),
        constants=DeviceArray.of(queue, constants_of(model, balls)),
        incoming_begin=_whole(queue, np.concatenate([[0], ends])),
        incoming=_whole(queue, pairs_of_balls[np.argsort(partner_rows, kind="stable")]),
        history=DeviceArray.of(queue, _with_room(balls.history.T, stride, 4).T),
        push=DeviceArray(queue, (2 * stride, 4)),
        spring=spring,
        moment=moment,
    )


def _whole(queue: Any, array: NDArray[Any]) -> DeviceArray:
    """Copy whole numbers to the device, where they have 32 bits."""
    return DeviceArray.of(queue, array.astype(np.int32))


def _with_room(rows: Numbers, count: int, width: int) -> Numbers:
    """Return an array (count, width) that begins with other rows (n, w)."""
    padded = np.zeros((count, width))
    padded[: rows.shape[0], : rows.shape[1]] = rows
    return padded


def constants_of(model: Model, balls: BallPairs) -> Numbers:
    """Constants (kinds of pairs, 4 WIDTH) of contact, and behind them those of rolling."""
    constants = np.zeros((len(balls.constants), 4 * WIDTH))
    constants[:, :7] = balls.constants
    if balls.rolling_moment is not None:
        _, first_of_kind = np.unique(balls.constants_row, return_index=True)
        constants[:, 7:9] = rolling_constants(
            model, balls.row[first_of_kind], balls.partner[first_of_kind]
        )
    return constants
