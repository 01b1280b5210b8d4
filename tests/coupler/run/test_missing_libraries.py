"""What a user left out of the installation is named when it is needed, and only then."""

import json
import sys

import pytest

from quintet.coupler.cli import main
from quintet.interfaces.libraries import require


@pytest.fixture
def lacks(monkeypatch):
    """Let libraries be as if not installed."""
    return lambda library: monkeypatch.setitem(sys.modules, library, None)


def ended_with(*arguments):
    with pytest.raises(SystemExit) as ended:
        main([*map(str, arguments)])
    return ended.value.code


def test_a_run_over_zenoh_names_the_extra_before_anything_is_written(tmp_path, lacks, capsys):
    lacks("zenoh")
    out = tmp_path / "run"
    assert ended_with("run", "two_springs", "--transport", "zenoh", "--out", out) == 2
    message = "transport zenoh needs the library zenoh; it is not installed"
    assert message in (told := capsys.readouterr().err)
    assert "pip install 'quintet[zenoh]'" in told
    assert not out.exists()


def test_a_run_in_one_process_needs_neither_and_says_why_it_draws_nothing(tmp_path, lacks, capsys):
    lacks("zenoh")
    lacks("matplotlib")
    assert ended_with("run", "two_springs", "--transport", "memory", "--out", tmp_path / "run") == 0
    told = capsys.readouterr().err
    assert "no pictures: matplotlib is not installed" in told
    assert "pip install 'quintet[pictures]'" in told
    assert json.loads((tmp_path / "run/results.json").read_text())["status"] == "done"
    assert not list((tmp_path / "run").glob("*.png"))


def test_a_library_that_is_there_is_not_imported():
    before = set(sys.modules)
    require("zenoh", "transport zenoh")
    assert not {name for name in set(sys.modules) - before if name.startswith("zenoh")}
