"""The command that tries all faults resumes an interrupted series, and can try some faults only."""

import json

import fault_matrix
import pytest
from fault_matrix import Cell, cells, main, worst


def test_cells_that_were_right_are_not_tried_again(tmp_path, monkeypatch, capsys):
    keys, path = [], tmp_path / "cells.json"
    result = {"broken": [], "told": None, "said": 0.1, "cause": "c"}
    monkeypatch.setattr(Cell, "run", lambda cell, *_: keys.append(cell.key) or result)
    monkeypatch.setattr(fault_matrix, "write_tables", lambda results: None)
    arguments = ["--cells", str(path), "--fault", "exception", "--moment", "build"]
    assert main([*arguments, "--transport", "mpi"]) == 0
    assert main(arguments) == 0
    assert keys == [f"exception, build, {transport}" for transport in ("mpi", "memory", "zenoh")]
    cells = json.loads(path.read_text())
    cells["exception, build, zenoh"]["broken"] = ["status 3; found 0"]
    path.write_text(json.dumps(cells))
    assert main(arguments) == 0
    assert keys[3:] == ["exception, build, zenoh"]
    assert "cells are missing: the tables are not written" in capsys.readouterr().out


def test_an_unknown_fault_is_refused(capsys):
    with pytest.raises(SystemExit):
        main(["--fault", "flood"])
    assert "--fault must be of NaN, None, SIGKILL" in capsys.readouterr().err


def test_a_cell_has_the_worst_of_its_results():
    results = [
        {"broken": [], "told": naming_delay, "said": 8.1, "cause": ""}
        for naming_delay in (5.1, 5.3)
    ]
    assert worst([*results, None]) == "5.3 s, 8.1 s" and worst([None]) == ""
    assert worst([*results, {**results[0], "broken": ["status 3"]}]) == "status 3"


def test_every_cell_has_a_name_of_its_own():
    keys = [cell.key for cell in cells()]
    assert len(set(keys)) == len(keys) > 300
