"""A run with a rank that fails ends in time, names component, rank and host, and leaves nothing."""

import pytest
from rank_faults import CASES, fail, wrong

# Each fault and each moment with each transport once or more.
DEFAULT = {
    ("exception", "build", "zenoh"),
    ("exception", "later window", "mpi"),
    ("sys.exit", "first window", "mpi"),
    ("os._exit", "build", "mpi"),
    ("SIGKILL", "later window", "zenoh"),
    ("SIGSTOP", "first window", "zenoh"),
    ("endless loop", "later window", "mpi"),
    ("deadlock", "build", "zenoh"),
    ("deadlock", "first window", "mpi"),
    ("NaN", "build", "mpi"),
    ("NaN", "later window", "zenoh"),
}
LOADED = 3.0  # s that a loaded machine may add
MARKS = {"zenoh": pytest.mark.zenoh, "mpi": pytest.mark.mpi}


def cases(includes):
    """Parameters of a test."""
    return [
        pytest.param(
            fault,
            moment,
            transport,
            id=f"{fault.name}, {moment}, {transport}",
            marks=MARKS[transport],
        )
        for fault, moment, transport in CASES
        if includes(fault.name, moment, transport)
    ]


@pytest.mark.parametrize(("fault", "moment", "transport"), cases(lambda *case: case in DEFAULT))
def test_a_rank_that_fails_is_named(tmp_path, fault, moment, transport):
    outcome = fail(fault, moment, transport, tmp_path / "run", 2.0)
    assert wrong(fault, moment, 2.0, outcome, LOADED) == []


@pytest.mark.full
@pytest.mark.parametrize(("fault", "moment", "transport"), cases(lambda *case: True))
def test_every_fault_of_a_rank_at_every_moment(tmp_path, fault, moment, transport):
    outcome = fail(fault, moment, transport, tmp_path / "run", 8.0)
    assert wrong(fault, moment, 8.0, outcome) == []
