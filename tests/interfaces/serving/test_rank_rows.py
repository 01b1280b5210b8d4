"""Ranks get the rows of ports that they need, and tell which rows they compute."""

import numpy as np

from quintet.interfaces.component import Component, Field, Port
from quintet.interfaces.lines.message import Message
from quintet.interfaces.ports import MOTION
from quintet.interfaces.serving.rank_rows import (
    computes,
    first_not_finite,
    needed_rows,
    with_all_rows,
    with_rows,
)

ROWS = {"push": np.array([4, 1])}


class Half(Component):
    takes = (Port("push", (Field("load", (3,), "N", "impulse"),)), MOTION)
    gives = (Port("points", (Field("number", (), "1"),)),)

    def rank_rows(self, port):
        return np.array([1, 4])

    def stable_dt(self):
        return 1.0

    def take(self, fields):
        pass

    def step(self, dt):
        pass

    def give(self, wanted):
        return {}

    def save(self):
        return {}

    def load(self, state):
        pass


def order(name):
    fields = {"push.load": np.arange(18.0).reshape(6, 3), "other.number": np.ones(2)}
    return Message({"order": name, "window": 3}, fields)


def test_a_rank_gets_its_rows_and_zeros_in_place_of_the_others():
    header, sent = with_rows(order("advance"), ROWS)
    assert sent["push.load"].shape == (2, 3)
    received = with_all_rows(Message(header, dict(sent)), ROWS)
    loads, rows = order("advance").fields["push.load"], ROWS["push"]
    assert (received.fields["push.load"][rows] == loads[rows]).all()
    assert not np.delete(received.fields["push.load"], rows, axis=0).any()
    assert (received.fields["other.number"] == 1.0).all()
    assert received.header == {"order": "advance", "window": 3}


def test_states_go_whole_to_every_rank():
    header, sent = with_rows(order("load"), ROWS)
    assert len(with_all_rows(Message(header, dict(sent)), ROWS).fields["push.load"]) == 6


def test_without_chosen_rows_all_go_to_every_rank():
    assert len(with_rows(order("advance"), {})[1]["push.load"]) == 6


def test_ports_with_rotations_go_whole_for_zeros_are_no_rotation():
    assert list(needed_rows(Half())) == ["push"]


def test_the_rank_of_a_number_that_is_not_finite_is_known_by_its_row():
    fields = {"points.number": np.array([0.0, 1.0, 2.0, 3.0, np.inf])}
    key, row = first_not_finite(fields)
    assert (key, row) == ("points.number", 4)
    assert computes(Half(), {"key": key, "row": row}) is True
    assert computes(Half(), {"key": key, "row": 0}) is False
    assert first_not_finite({"points.number": np.ones(5)}) is None
