"""A check runs no code of the scene: only a run does, and reports it."""

import sys

import pytest

import quintet
from quintet.coupler.cli import main
from quintet.coupler.scene.foreign_code import is_trusted
from quintet.coupler.scene.read import library

SCENE = """
name = "foreign"
end = 1.0
window = 0.1
transport = "memory"
[components.here]
kind = "{kind}"
key = 1
[components.tank]
kind = "replay"
recording = "none"
component = "tank"
[[links]]
kind = "direct"
pairs = [["here.out", "tank.in"]]
[output]
fields = ["here.out.force"]
[[expect]]
name = "a"
component = "here"
field = "out.force"
measure = "max"
value = 1.0
within = 0.1
unit = "N"
source = "none"
"""
CODE = "import pathlib\npathlib.Path(__file__).with_name('ran').write_text('')\nclass Thing: pass\n"


def status(*arguments):
    with pytest.raises(SystemExit) as exit_info:
        main([str(argument) for argument in arguments])
    return exit_info.value.code


@pytest.fixture
def scene(tmp_path, monkeypatch):
    """A scene with code beside it; the code leaves a file when it runs."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "foreign_code_of_a_test.py").write_text(CODE)
    path = tmp_path / "scene.toml"
    path.write_text(SCENE.format(kind="foreign_code_of_a_test:Thing"))
    yield path
    sys.modules.pop("foreign_code_of_a_test", None)


@pytest.mark.parametrize(
    "command", [["check"], ["check", "--graph"], ["check", "--mermaid"], ["schema"]]
)
def test_reading_a_scene_runs_no_code_of_it(scene, command, capsys):
    scene.write_text(scene.read_text().split("[components.tank]")[0])
    assert status(command[0], scene, *command[1:]) == 0
    output = "".join(capsys.readouterr())
    assert "not checked: keys, ports, links and expectations of here" in output
    assert not (scene.parent / "ran").exists()


def test_links_outputs_and_expectations_of_unread_code_are_left_open(scene, capsys):
    text = scene.read_text()
    tank = text[text.index("[components.tank]") : text.index("[[links]]")]
    table = '[components.other]\nkind = "foreign_code_of_a_test:Thing"\n'
    scene.write_text(text.replace(tank, table).replace("tank.in", "other.in"))
    assert status("check", scene) == 0
    assert "expectations of here, other, as" in capsys.readouterr().out
    assert status("check", scene, "--set", "window=2.0") == 2
    assert "window must not exceed" in capsys.readouterr().err
    assert not (scene.parent / "ran").exists()


def test_python_checks_without_running_code(scene):
    scene.write_text(scene.read_text().split("[components.tank]")[0])
    assert "not checked" in str(quintet.check(scene))
    assert not (scene.parent / "ran").exists()
    with pytest.raises(quintet.SceneError, match="is not a Component"):
        quintet.check(scene, imports=True)
    assert (scene.parent / "ran").exists()


@pytest.mark.parametrize("command", ["check", "run"])
def test_code_is_imported_where_it_is_asked_for_and_told(scene, command, capsys):
    assert status(command, scene, *(["--import"] if command == "check" else [])) == 2
    screen = capsys.readouterr()
    file = scene.with_name("foreign_code_of_a_test.py")
    assert f"kind foreign_code_of_a_test:Thing is code: importing {file}" in screen.out
    assert "is not a Component" in screen.err and (scene.parent / "ran").exists()


@pytest.mark.parametrize("kind", ["os:system", "antigravity:x", "http.server:main", "a.b:C"])
def test_a_module_that_a_scene_picks_is_not_imported(scene, kind):
    scene.write_text(SCENE.format(kind=kind).split("[components.tank]")[0])
    modules = set(sys.modules)
    assert status("check", scene) == 0
    assert kind.partition(":")[0] in modules or kind.partition(":")[0] not in sys.modules


def test_scenes_that_come_with_quintet_are_checked_whole(capsys):
    assert status("check", "two_springs") == 0
    screen = capsys.readouterr()
    assert "link spring: lower -> upper" in screen.out and "importing" not in screen.out
    folder = library()["two_springs"].parent
    assert is_trusted("springs:Mass", folder)
    assert is_trusted("quintet.scenarios.two_springs.springs:Mass", folder.parent)
    assert not is_trusted("os:system", folder)


def test_a_module_of_python_does_not_pass_for_code_of_quintet(monkeypatch, tmp_path):
    """Python would not import a file beside a scene of ours."""
    folder = library()["two_springs"].parent
    (tmp_path / "springs.py").write_text("")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "springs", raising=False)
    assert not is_trusted("springs:Mass", folder)
