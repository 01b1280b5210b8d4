"""The command that tries all faults: it goes on where it was ended, and can try a part."""

import json

import fault_matrix
import pytest
from fault_matrix import Cell, cells, main, worst


def test_cells_that_were_right_are_not_tried_again(tmp_path, monkeypatch, capsys):
    tried, path = [], tmp_path / "cells.json"
    right = {"broken": [], "told": None, "said": 0.1, "cause": "c"}
    monkeypatch.setattr(Cell, "run", lambda cell, *_: tried.append(cell.key) or right)
    monkeypatch.setattr(fault_matrix, "write_tables", lambda results: None)
    part = ["--cells", str(path), "--fault", "exception", "--moment", "build"]
    assert main([*part, "--transport", "mpi"]) == 0
    assert main(part) == 0
    assert tried == [f"exception, build, {over}" for over in ("mpi", "memory", "zenoh")]
    known = json.loads(path.read_text())
    known["exception, build, zenoh"]["broken"] = ["status 3; found 0"]
    path.write_text(json.dumps(known))
    assert main(part) == 0
    assert tried[3:] == ["exception, build, zenoh"]
    assert "cells are missing: the tables are not written" in capsys.readouterr().out


def test_an_unknown_fault_is_refused(capsys):
    with pytest.raises(SystemExit):
        main(["--fault", "flood"])
    assert "--fault must be of NaN, None, SIGKILL" in capsys.readouterr().err


def test_a_cell_has_the_worst_of_its_results():
    results = [{"broken": [], "told": told, "said": 8.1, "cause": ""} for told in (5.1, 5.3)]
    assert worst([*results, None]) == "5.3 s, 8.1 s" and worst([None]) == ""
    assert worst([*results, {**results[0], "broken": ["status 3"]}]) == "status 3"


def test_every_cell_has_a_name_of_its_own():
    keys = [cell.key for cell in cells()]
    assert len(set(keys)) == len(keys) > 300
