"""Listed pairs of balls in the memory of a device, with the history of their contacts."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.dem_bodies.contact.ball_pairs import ball_pairs
from quintet.components.dem_bodies.kernels.rolling_resistance import rolling_constants
from quintet.components.dem_bodies.opencl.programs import WIDTH
from quintet.components.dem_bodies.state import BallPairs, Model, Numbers, Short, Whole
from quintet.components.shared.opencl.arrays import DeviceArray

MOST_LANES = 4  # pairs that are computed at once


@dataclass(frozen=True, slots=True)
class DevicePairs:
    """`BallPairs` in device memory, and for each row the pairs in which it is the partner.

    `push` and `moment` also have slots for pairs of other ranks, after this rank's own.
    """

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
    push: DeviceArray  # (room, 8) force [N] and depth [m]; force × normal [N], energy [J]
    spring: DeviceArray | None  # (stride, 4) N m, elastic moment; None if no pair resists rolling
    moment: DeviceArray | None  # (room, 4) N m, all of it, and energy [J]

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
            balls.force[:] = self.push.get()[: self.count, :3]


class NumberedPairs(NamedTuple):
    """Pairs by the numbers of a device's rows: own balls, copies, the ground, then planes."""

    begin: Whole  # (b + 1,)
    row: Whole | Short  # (pairs,)
    partner: Whole | Short  # (pairs,)
    incoming_begin: Whole  # (b + 1,)
    incoming: Whole  # pairs; from `stride_of` their number on, those of other ranks
    arrived: int  # how many pairs of other ranks


def all_pairs(balls: BallPairs) -> NumberedPairs:
    """Pairs of all balls on one device, which has the host's numbers."""
    rows = len(balls.begin) - 1
    pairs_of_balls = np.flatnonzero(balls.partner < rows)
    partner_rows = balls.partner[pairs_of_balls]
    ends = np.cumsum(np.bincount(partner_rows, minlength=rows))
    return NumberedPairs(
        balls.begin,
        balls.row,
        balls.partner,
        np.concatenate([[0], ends]),
        pairs_of_balls[np.argsort(partner_rows, kind="stable")],
        0,
    )


def stride_of(count: int) -> int:
    """Room for so many pairs: a multiple of the pairs that are computed at once."""
    return -(-count // MOST_LANES) * MOST_LANES


def pairs_of_host(queue: Any, model: Model, balls: BallPairs, pairs: NumberedPairs) -> DevicePairs:
    """Copy the host's pairs with their history, by the device's numbers."""
    count = len(balls.partner)
    stride = stride_of(count)
    room = stride + pairs.arrived
    spring = moment = None
    if balls.rolling_moment is not None:
        spring = DeviceArray.of(queue, _with_room(balls.rolling_moment, stride, 4))
        moment = DeviceArray(queue, (room, 4))
    return DevicePairs(
        count=count,
        stride=stride,
        begin=_whole(queue, pairs.begin),
        row=_whole(queue, pairs.row),
        partner=_whole(queue, pairs.partner),
        constants_row=_whole(queue, balls.constants_row),
        constants=DeviceArray.of(queue, constants_of(model, balls)),
        incoming_begin=_whole(queue, pairs.incoming_begin),
        incoming=_whole(queue, pairs.incoming),
        history=DeviceArray.of(queue, _with_room(balls.history.T, stride, 4).T),
        push=DeviceArray(queue, (room, 8)),
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
