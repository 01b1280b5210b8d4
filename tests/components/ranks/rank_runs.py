"""Runs of a solver on several MPI ranks for its tests, and the differences between them.

``NAME-RANKS.npz`` holds the state and all results of a run from the start, and
``NAME-RANKS-EARLIER.npz`` of one that goes on from the state of as many ranks as EARLIER says.
"""

from pathlib import Path

import numpy as np
import pytest

RANK_PROGRAM = Path(__file__).with_name("rank_program.py")
MOVED = "moved"


def differences(folder, first, second):
    """Names of the arrays that differ in a bit."""
    first_run, second_run = np.load(folder / f"{first}.npz"), np.load(folder / f"{second}.npz")
    assert set(first_run.files) == set(second_run.files)
    return [
        name for name in first_run.files if first_run[name].tobytes() != second_run[name].tobytes()
    ]


def from_the_start(program, names, steps, ranks=(1, 2), moved=()):
    """Return a fixture: a folder with runs of all cases on each number of ranks.

    On those in `moved` the borders between ranks are moved.
    """

    @pytest.fixture(scope="module")
    def folder(tmp_path_factory, on_ranks):
        folder, cases = tmp_path_factory.mktemp("ranks"), ",".join(names)
        for number in ranks:
            words = [program, folder, steps, 0, cases, *[MOVED] * (number in moved)]
            on_ranks(RANK_PROGRAM, number, *words, seconds=300)
        return folder

    return folder


def from_states(program, names, steps, pairs=((1, 1), (3, 2))):
    """Return a fixture: runs on some ranks that go on from the states of others.

    Runs on three ranks have their borders moved.
    """

    @pytest.fixture(scope="module")
    def resumed(folder, on_ranks):
        for ranks, earlier in pairs:
            words = [program, folder, steps, earlier, ",".join(names), *[MOVED] * (ranks == 3)]
            on_ranks(RANK_PROGRAM, ranks, *words, seconds=300)
        return folder

    return resumed
