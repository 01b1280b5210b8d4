"""A long run holds as much memory as a short one, loses no descriptor, and writes what it records.

``python tests/coupler/faults/endurance.py`` draws the same.
"""

import pytest
from endurance import FILES, endure, table

MOST = {"coupler": 10.0}  # bytes a window in the second half of the windows
MOST_OF_OTHERS = 2.0
MOST_OF_SHORT = 2e5  # bytes in the second half of 2000 windows, in which nothing is loaded late
SPARE = 2  # descriptors that are open for a moment: a snapshot, its folder


def check_files_and_descriptors(samples, report):
    for name, size in report["files"].items():
        assert size < FILES[name], table(report)
    processes = report["processes"]
    for name, rows in samples.rows.items():
        counts = [row[4] for row in rows if 0.05 * report["windows"] < row[0] < report["windows"]]
        if name.rpartition(" ")[0] in processes and counts:
            assert max(counts) <= min(counts) + SPARE, table(report)


@pytest.mark.slow
@pytest.mark.zenoh
def test_two_thousand_windows_lose_no_descriptor_and_hold_no_memory(tmp_path):
    # With restarts the first snapshot, after 5 s, would load modules in the second half.
    samples, report = endure(tmp_path, 2000, "zenoh", interval=0.05)
    assert {"coupler", "ping", "pong", "companion"} <= set(report["processes"])
    for name, row in report["processes"].items():
        assert row["growth"] < MOST_OF_SHORT, f"{name}: {table(report)}"
    # The whole file: rows are written in batches, so that its growth between two looks varies.
    del report["files"]["recording.h5"]
    recorded = (samples.run.folder / "recording.h5").stat().st_size / 2000  # bytes a window
    assert 400.0 < recorded < FILES["recording.h5"], "it is recorded"
    check_files_and_descriptors(samples, report)


RUNS = {
    "zenoh": {},
    "zenoh with restarts": {"restarts": True},
    "zenoh without recording": {"record": False, "views": False},
    "mpi": {},
}


@pytest.mark.full
@pytest.mark.parametrize("case", RUNS)
def test_two_hundred_thousand_windows_end_with_the_memory_of_half_as_many(tmp_path, case):
    samples, report = endure(tmp_path, 200_000, case.split()[0], **RUNS[case])
    print(table(report))
    for name, row in report["processes"].items():
        assert row["slope"] < MOST.get(name, MOST_OF_OTHERS), table(report)
    check_files_and_descriptors(samples, report)
