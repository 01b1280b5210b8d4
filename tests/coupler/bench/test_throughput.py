"""The benchmark of a component counts its own steps, items and processor time, and no others."""

import json

import pytest
import toys

from quintet.coupler.cli import main
from quintet.interfaces.manifest import find, known_kinds
from quintet.interfaces.params import read

KIND = "toys:COUNTED"
KEYS = {"name", "case", "items", "threads", "rate", "unit", "cpu_seconds", "wall_seconds"}


def bench(*arguments):
    with pytest.raises(SystemExit) as exit_info:
        main(["bench", *map(str, arguments)])
    return exit_info.value.code


@pytest.fixture
def beside_the_toys(monkeypatch):
    monkeypatch.chdir(toys.__file__.rpartition("/")[0])


def test_a_case_is_measured_in_steps_of_its_items(tmp_path, capsys, beside_the_toys):
    file = tmp_path / "found.json"
    assert bench(KIND, "--case", "small", "--threads", 1, "--json", file) == 0
    (row,) = json.loads(file.read_text())
    assert row.keys() >= {*KEYS, "bytes_per_item", "options", "wall_rate"}
    assert (row["case"], row["items"], row["unit"]) == ("small", 7, "toy-steps/s")
    assert row["options"] == {"steps": 20, "warm": 3, "params": {"items": 7, "pause": 0.005}}
    # Each step sleeps for 5 ms: by the clock they take that long, on the processor far less.
    assert 0.1 <= row["wall_seconds"] and row["cpu_seconds"] < row["wall_seconds"]
    assert row["wall_rate"] == pytest.approx(7 * 20 / row["wall_seconds"])
    assert row["rate"] == pytest.approx(7 * 20 / row["cpu_seconds"])
    assert "toy-steps/s" in capsys.readouterr().out


def test_memory_is_what_the_component_holds(tmp_path, beside_the_toys):
    file = tmp_path / "found.json"
    assert bench(KIND, "--case", "large", "--threads", 1, "--json", file) == 0
    (row,) = json.loads(file.read_text())
    # A million items of two arrays of three doubles; a step makes a third, and drops one.
    assert row["bytes_per_item"] == pytest.approx(48.0, rel=0.05)


def test_more_threads_are_compared_with_one(tmp_path, capsys, beside_the_toys):
    assert bench(KIND, "--case", "small", "--threads", 1, "--threads", 2) == 0
    row = capsys.readouterr().out.splitlines()[-1].split()
    assert row[:3] == ["small", "7", "2"] and 0.5 < float(row[5]) < 2.0


def test_what_cannot_be_measured_is_refused(capsys, beside_the_toys):
    assert bench(KIND, "--case", "smal") == 2
    assert "case smal is not known. Did you mean small?" in capsys.readouterr().err
    assert bench("toys:Toy") == 2
    assert "it declares no case. Name a function as Manifest.bench." in capsys.readouterr().err
    assert bench(KIND, "--threads", 0) == 2
    assert "--threads must be a whole number from 1; found 0." in capsys.readouterr().err


@pytest.mark.parametrize("kind", [kind for kind in known_kinds() if find(kind).bench])
def test_the_cases_of_every_kind_are_valid(kind):
    manifest = find(kind)
    cases = manifest.cases()
    assert cases
    for case in cases:
        assert not read(manifest.params, case.params, case.name)[1]


@pytest.mark.mpi
def test_ranks_that_share_a_component_are_compared_with_one(tmp_path, capsys):
    file = tmp_path / "found.json"
    arguments = ("--case", "vortex, 10k nodes, 9 neighbours", "--threads", 1, "--json", file)
    assert bench("meshless_gas", *arguments, "--ranks", 1, "--ranks", 2) == 0
    one_rank, two_ranks = json.loads(file.read_text())
    assert (one_rank["ranks"], two_ranks["ranks"], one_rank["waits"]) == (1, 2, 0.0)
    assert two_ranks["items"] == one_rank["items"] and 0.0 < two_ranks["waits"] < 1.0
    assert (one_rank["imbalance"], one_rank["collectives"], one_rank["gathered_bytes"]) == (
        1.0,
        0.0,
        0.0,
    )
    assert 1.0 <= two_ranks["imbalance"] < 2.0 and two_ranks["collectives"] >= 1.0
    assert 1000 < two_ranks["halo_bytes"] < 5000 * 5 * 8  # of nodes near the border only
    assert two_ranks["gathered_bytes"] < 1000
    assert two_ranks["network"]["latency"] > 0.0 and two_ranks["network"]["bandwidth"] > 0.0
    assert "ranks" in capsys.readouterr().out


def test_ranks_of_a_kind_that_has_one_are_refused(capsys, beside_the_toys):
    assert bench(KIND, "--ranks", 2) == 2
    assert f"for kind {KIND} computes on one rank; found 2" in capsys.readouterr().err
    assert bench(KIND, "--ranks", 0) == 2
    assert "--ranks must be a whole number from 1; found 0." in capsys.readouterr().err
