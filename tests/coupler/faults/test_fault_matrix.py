"""A run with a fault ends in time, says who, when and why, and leaves nothing behind."""

import pytest
from fault_matrix import CASES, fail, wrong

# One case of each class, each fault once.
DEFAULT = {
    "exception": "mpi",
    "sys.exit": "memory",
    "os._exit": "zenoh",
    "SIGKILL": "mpi",
    "SIGSTOP": "mpi",
    "deadlock": "memory",
    "endless loop": "zenoh",
    "compiled loop": "memory",
    "polling loop": "mpi",
    "NaN": "zenoh",
    "wrong shape": "memory",
    "out of memory": "zenoh",
    "SIGSEGV": "mpi",
    "impulse of wrong shape": "memory",
    "complex": "zenoh",
    "None": "mpi",
    "huge": "zenoh",
}
LOADED = 3.0  # s that a loaded machine may add
IDS = [f"{fault.name}, {transport}" for fault, transport in CASES]
SHORT = [(fault, transport) for fault, transport in CASES if DEFAULT[fault.name] == transport]


@pytest.mark.parametrize(
    ("fault", "transport"), SHORT, ids=[f"{fault.name}, {over}" for fault, over in SHORT]
)
def test_a_fault_ends_the_run_with_a_report(tmp_path, fault, transport):
    found = fail(fault, transport, tmp_path, 2.0)
    assert wrong(fault, transport, 2.0, found, LOADED) == []


@pytest.mark.full
@pytest.mark.parametrize(("fault", "transport"), CASES, ids=IDS)
def test_a_hang_is_told_before_it_is_ended(tmp_path, fault, transport):
    found = fail(fault, transport, tmp_path, 9.0)
    assert wrong(fault, transport, 9.0, found) == []
    if fault.kind == "hangs":
        assert found.told < 7.0 < 9.0 < found.said
