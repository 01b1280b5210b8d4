"""Runs of a solver on several MPI ranks for its tests, and what differs between them.

The program of a solver takes a folder, a number of steps, the number of ranks that left the state
from which it goes on (0: it begins at the start), and names of cases. On rank 0 it writes the state
and all results: ``NAME-RANKS-state.npz`` and ``NAME-RANKS.npz``, or ``NAME-RANKS-EARLIER.npz``.
"""

from pathlib import Path

import numpy as np
import pytest

MOVED_BORDERS = Path(__file__).with_name("moved_borders.py")


def differences(folder, first, second):
    """Names of the arrays that differ in a bit."""
    one, other = np.load(folder / f"{first}.npz"), np.load(folder / f"{second}.npz")
    assert set(one.files) == set(other.files)
    return [name for name in one.files if one[name].tobytes() != other[name].tobytes()]


def from_the_start(program, names, steps, *more, ranks=(1, 2)):
    """Return a fixture: a folder with runs of all cases on each number of ranks."""

    @pytest.fixture(scope="module")
    def folder(tmp_path_factory, on_ranks):
        folder = tmp_path_factory.mktemp("ranks")
        for number in ranks:
            on_ranks(program, number, folder, steps, 0, ",".join(names), *more, seconds=300)
        return folder

    return folder


def from_states(program, names, steps, *more, pairs=((1, 1), (3, 2))):
    """Return a fixture: runs on some ranks that go on from the states of others.

    Three ranks have their borders elsewhere than they would have them.
    """

    @pytest.fixture(scope="module")
    def resumed(folder, on_ranks):
        for ranks, earlier in pairs:
            arguments = (folder, steps, earlier, ",".join(names), *more)
            if ranks == 3:
                on_ranks(MOVED_BORDERS, ranks, program, *arguments, seconds=300)
            else:
                on_ranks(program, ranks, *arguments, seconds=300)
        return folder

    return resumed
