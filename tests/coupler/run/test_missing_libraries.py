"""A library that is not installed is named when a run needs it, and only then."""

import json
import sys

import pytest

from quintet.coupler.cli import main
from quintet.interfaces.libraries import require


@pytest.fixture
def lacks(monkeypatch):
    """Make libraries look as if not installed."""
    return lambda library: monkeypatch.setitem(sys.modules, library, None)


def exit_status(*arguments):
    with pytest.raises(SystemExit) as exit_info:
        main([*map(str, arguments)])
    return exit_info.value.code


def test_a_run_over_zenoh_names_the_extra_before_anything_is_written(tmp_path, lacks, capsys):
    lacks("zenoh")
    out = tmp_path / "run"
    assert exit_status("run", "two_springs", "--transport", "zenoh", "--out", out) == 2
    message = "transport zenoh needs the library zenoh; it is not installed"
    assert message in (error_text := capsys.readouterr().err)
    assert "pip install 'quintet[zenoh]'" in error_text
    assert not out.exists()


def test_a_run_in_one_process_needs_neither_and_says_why_it_draws_nothing(tmp_path, lacks, capsys):
    lacks("zenoh")
    lacks("matplotlib")
    assert (
        exit_status("run", "two_springs", "--transport", "memory", "--out", tmp_path / "run") == 0
    )
    error_text = capsys.readouterr().err
    assert "no pictures: matplotlib is not installed" in error_text
    assert "pip install 'quintet[pictures]'" in error_text
    assert json.loads((tmp_path / "run/results.json").read_text())["status"] == "done"
    assert not list((tmp_path / "run").glob("*.png"))


def test_a_library_that_is_there_is_not_imported():
    modules = set(sys.modules)
    require("zenoh", "transport zenoh")
    assert not {name for name in set(sys.modules) - modules if name.startswith("zenoh")}
