"""The table of studies in README is that of the studies that are kept beside the scenes."""

import json
from pathlib import Path

from quintet.coupler.report.marked_place import STUDIES as PLACE
from quintet.coupler.report.studies_table import table_of
from quintet.coupler.scene.read import library, parse

FOLDER = Path(__file__).resolve().parents[2] / "scenarios"
STUDIES = json.loads((FOLDER / "studies.json").read_text())


def test_the_table_is_what_was_measured():
    assert PLACE.read(FOLDER / "README.md") == table_of(STUDIES)


def test_all_refinements_of_all_scenes_are_in_it_as_they_are_now():
    recorded = {s["scene"]: [(row["label"], row["settings"]) for row in s["rows"]] for s in STUDIES}
    tables = {name: parse(path).get("study", []) for name, path in library().items()}
    current = {
        name: [(row["label"], row["settings"]) for row in rows]
        for name, rows in tables.items()
        if rows
    }
    assert recorded == current


def test_every_row_that_was_measured_says_when_and_on_what():
    rows = [row for study in STUDIES for row in study["rows"] if row["status"] == "done"]
    assert rows
    for row in rows:
        assert row["date"] and row["on"]["cpu"] and row["on"]["cores"]
