"""The benchmark of the exchange measures each transport, and writes its results."""

import json

import pytest

from quintet.coupler.bench import exchange, raw_transport
from quintet.coupler.cli import main
from quintet.interfaces.errors import QuintetError

OVER = [pytest.param("zenoh", marks=pytest.mark.zenoh), pytest.param("mpi", marks=pytest.mark.mpi)]
KEYS = {
    "name",
    "case",
    "items",
    "threads",
    "rate",
    "unit",
    "median_ms",
    "p99_ms",
    "library_ms",
    "options",
}


@pytest.mark.parametrize("transport", OVER)
def test_the_exchange_is_measured(tmp_path, monkeypatch, capsys, transport):
    monkeypatch.setattr(exchange, "SIZES", {100: 200, 1000: 100})
    file = tmp_path / "found.json"
    with pytest.raises(SystemExit) as exit_info:
        main(["bench", "exchange", "--transport", transport, "--json", str(file)])
    assert exit_info.value.code == 0
    rows = json.loads(file.read_text())
    assert [row["items"] for row in rows] == [100, 1000]
    for row, size in zip(rows, ("2.4 kB", "24 kB"), strict=True):
        assert row.keys() >= KEYS and size in row["case"] and transport in row["case"]
        assert row["unit"] == "windows/s" and row["rate"] > 20.0
        assert 0.0 < row["median_ms"] <= row["p99_ms"] and row["library_ms"] > 0.0
    assert capsys.readouterr().out.count("windows/s") == 2


def test_an_unknown_benchmark_is_refused(capsys):
    with pytest.raises(SystemExit) as exit_info:
        main(["bench", "exchnge"])
    assert exit_info.value.code == 2
    assert "bench exchnge is not known. Did you mean exchange?" in capsys.readouterr().err


def test_a_library_that_does_not_end_well_is_told_with_what_it_said(monkeypatch):
    monkeypatch.setattr(raw_transport, "free_port", lambda: "nowhere")
    with pytest.raises(
        QuintetError, match=r"must end with status 0 within 120 s; found \[(.|\n)+Error"
    ):
        raw_transport.round_trip("zenoh", 2400, 10)
