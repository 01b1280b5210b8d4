"""Limits of all scenes at once, and the table that they make."""

import json
from functools import partialmethod
from threading import Barrier

from spring_scene import command, write

from quintet.coupler.report.stability_tables import markdown
from quintet.coupler.scene.read import load_variants
from quintet.coupler.study import stability
from quintet.interfaces.errors import SceneError

LIMIT = """
[[stability]]
parameter = "components.spring.step"
from = 0.15
to = 0.25
predicted = 0.2
source = "2/ω"
end = 12.0
bounds = [{ component = "spring", field = "motion.position", low = -1.5, high = 1.5 }]
accuracy = 0.5
"""


def test_limits_of_all_scenes_make_a_table(tmp_path, monkeypatch, capsys):
    scenes = {}
    for name in ("soft", "firm"):
        (tmp_path / name).mkdir()
        scenes[name] = write(tmp_path / name, LIMIT)
    (tmp_path / "none").mkdir()
    scenes["none"] = write(tmp_path / "none")  # has no limits
    monkeypatch.setattr(stability, "library", lambda: scenes)
    monkeypatch.setattr(stability, "load_variants", lambda name: load_variants(str(scenes[name])))
    readme, json_path = tmp_path / "README.md", tmp_path / "kept.json"
    readme.write_text("before\n<!-- stability -->\nold\n<!-- end of stability -->\nafter\n")
    at_once = Barrier(2, timeout=30.0)
    find = partialmethod(by_name, stability.Searches.find, scenes, at_once)
    monkeypatch.setattr(stability.Searches, "find", find)
    arguments = ("--all", "--json", json_path, "--readme", readme, "--out", tmp_path / "out")
    assert command("stability", *arguments) == 0
    content = json.loads(json_path.read_text())
    assert [entry["scene"] for entry in content] == ["firm", "soft"]
    lines = readme.read_text().splitlines()
    assert lines[0] == "before" and lines[-1] == "after" and "old" not in lines
    assert lines[2:-2] == list(markdown(content))
    assert command("stability", *arguments) == 0 and json.loads(json_path.read_text()) == content
    assert "soft: components.spring.step = 0.15: stable" in capsys.readouterr().out
    assert command("stability", "--all", "--jobs", 0) == 2
    assert "stability: --jobs must be 1 or more; found 0." in capsys.readouterr().err
    assert command("stability", scenes["soft"], "--jobs", 2) == 2
    assert "--jobs is for --all. Add --all, or remove it." in capsys.readouterr().err
    assert command("stability", "--all", "--set", "end=1.0") == 2
    assert "stability --all takes no --set" in capsys.readouterr().err
    assert command("stability") == 2 and "a scene or --all" in capsys.readouterr().err
    foreign_path = tmp_path / "alone.json"
    foreign_path.write_text(json.dumps(content[0]))
    assert command("stability", "--all", "--json", foreign_path) == 2
    assert "what this command left there before" in capsys.readouterr().err


def by_name(searches, find, scenes, at_once, name, *arguments):
    """Find limits of a scene of our own, that has no file in the library, two at once."""
    at_once.wait()
    return find(searches, str(scenes[name]), *arguments)


def test_a_scene_that_cannot_be_searched_leaves_the_others(tmp_path, monkeypatch, capsys):
    scenes = {}
    for name in ("soft", "firm"):
        (tmp_path / name).mkdir()
        scenes[name] = write(tmp_path / name, LIMIT)
    monkeypatch.setattr(stability, "library", lambda: scenes)
    monkeypatch.setattr(stability, "load_variants", lambda name: load_variants(str(scenes[name])))
    find = stability.Searches.find

    def find_in_firm(searches, name, limits, folder):
        if name == "soft":
            raise SceneError("its file is gone. Copy it back.")
        return find(searches, str(scenes[name]), limits, folder)

    monkeypatch.setattr(stability.Searches, "find", find_in_firm)
    assert (
        command("stability", "--all", "--json", tmp_path / "all.json", "--out", tmp_path / "out")
        == 3
    )
    assert "soft: its file is gone. Copy it back." in capsys.readouterr().err
    assert [entry["scene"] for entry in json.loads((tmp_path / "all.json").read_text())] == ["firm"]
