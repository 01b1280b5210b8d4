"""A failed run leaves the pictures due before the fault, and names only files that exist."""

import json

from spring_scene import command
from started import write_scene


def _failed(folder, pictures):
    pong = "seen = true\nfails_at = 30"
    scene = write_scene(folder, end=0.1, ping="seen = true", pong=pong)
    out = folder / "out"
    status = command("run", scene, "--set", f"output.pictures={pictures}", "--out", out)
    assert status == 3
    return out


def test_pictures_that_were_due_before_the_fault_are_drawn(tmp_path):
    out = _failed(tmp_path, "[0.0, 0.01, 0.09]")
    assert (out / "scene.png").is_file()


def test_no_picture_is_drawn_of_times_after_the_fault(tmp_path):
    assert not (_failed(tmp_path, "[0.09]") / "scene.png").exists()


def test_a_failure_over_memory_names_no_log(tmp_path, capsys):
    out = _failed(tmp_path, "[]")
    fault = json.loads((out / "results.json").read_text())["fault"]
    assert fault["component"] == "pong" and fault["log"] == ""
    screen = capsys.readouterr()
    assert "pong.log" not in screen.err + screen.out
