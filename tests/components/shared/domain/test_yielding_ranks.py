"""Waiting for other ranks: who holds the core meanwhile."""

import os

import pytest

waiting = pytest.importorskip("quintet.components.shared.domain.waiting")


@pytest.mark.parametrize(
    ("variable", "ranks", "polls"),
    [
        ("MPI_LOCALNRANKS", 2, waiting.SOON),
        ("MPI_LOCALNRANKS", 3, 0),
        ("OMPI_COMM_WORLD_LOCAL_SIZE", 3, 0),
    ],
)
def test_a_rank_yields_at_once_where_more_ranks_than_cores_are(monkeypatch, variable, ranks, polls):
    for name in waiting.RANKS_HERE:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: {0, 1})
    monkeypatch.setenv(variable, str(ranks))
    assert waiting.polls_before_yielding() == polls


def test_a_process_that_no_launcher_started_polls_first(monkeypatch):
    for name in waiting.RANKS_HERE:
        monkeypatch.delenv(name, raising=False)
    assert waiting.polls_before_yielding() == waiting.SOON
