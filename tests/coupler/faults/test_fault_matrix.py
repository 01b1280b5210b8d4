"""A run with a fault ends in time, names component, window and cause, and leaves nothing behind."""

import pytest
from component_faults import BY_NAME, CASES, LATER, expected, fail
from outcomes import broken_rules

# One case of each class, each fault once; each moment beside the later window once or more.
DEFAULT = [
    ("exception", LATER, "mpi"),
    ("sys.exit", LATER, "memory"),
    ("os._exit", LATER, "zenoh"),
    ("SIGKILL", "finish", "mpi"),
    ("SIGSTOP", "give", "mpi"),
    ("deadlock", LATER, "memory"),
    ("endless loop", LATER, "zenoh"),
    ("compiled loop", LATER, "memory"),
    ("polling loop", LATER, "mpi"),
    ("NaN", LATER, "zenoh"),
    ("wrong shape", "first window", "memory"),
    ("out of memory", LATER, "zenoh"),
    ("SIGSEGV", "build", "mpi"),
    ("impulse of wrong shape", LATER, "memory"),
    ("complex", LATER, "zenoh"),
    ("None", "finish", "mpi"),
    ("huge", LATER, "zenoh"),
    ("disk full", "build", "memory"),
    ("link cut", LATER, "zenoh"),
]
LOADED = 3.0  # s that a loaded machine may add
MARKS = {"memory": (), "zenoh": pytest.mark.zenoh, "mpi": pytest.mark.mpi}


def cases(cells):
    """Parameters of a test."""
    return [
        pytest.param(
            fault,
            moment,
            transport,
            id=f"{fault.name}, {moment}, {transport}",
            marks=MARKS[transport],
        )
        for fault, moment, transport in cells
    ]


SHORT = cases((BY_NAME[name], moment, transport) for name, moment, transport in DEFAULT)


@pytest.mark.parametrize(("fault", "moment", "transport"), SHORT)
def test_a_fault_ends_the_run_with_a_report(tmp_path, fault, moment, transport):
    outcome = fail(fault, moment, transport, tmp_path, 2.0)
    assert broken_rules(expected(fault, moment, transport, 2.0), outcome, LOADED) == []


@pytest.mark.full
@pytest.mark.parametrize(("fault", "moment", "transport"), cases(CASES))
def test_every_fault_at_every_moment(tmp_path, fault, moment, transport):
    outcome = fail(fault, moment, transport, tmp_path, 9.0)
    assert broken_rules(expected(fault, moment, transport, 9.0), outcome) == []
    if fault.kind == "hangs" and moment != "build":
        assert outcome.told < 7.0 < 9.0 < outcome.said
