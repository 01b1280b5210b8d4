"""A starting point of `quintet new` runs unchanged, and overwrites nothing."""

import os
import subprocess
import sys
import tomllib

import pytest

from quintet.coupler.cli import main
from quintet.coupler.reference.starting_points import TEMPLATES, starting_point, write_new
from quintet.coupler.report.show import results
from quintet.interfaces.errors import SceneError


@pytest.fixture
def write_start(tmp_path, monkeypatch):
    """Write a starting point, and offer its entry points to the processes that this one starts."""
    monkeypatch.chdir(tmp_path)

    def begin(template, name):
        with pytest.raises(SystemExit) as exit_info:
            main(["new", template, name])
        assert exit_info.value.code == 0
        folder = tmp_path / name
        if template != "scene":
            project = tomllib.loads((folder / "pyproject.toml").read_text())["project"]
            info = folder / f"{name}-{project['version']}.dist-info"
            info.mkdir()
            (info / "METADATA").write_text(f"Name: {name}\nVersion: {project['version']}\n")
            ((group, points),) = project["entry-points"].items()
            lines = [f"[{group}]", *(f"{key} = {value}" for key, value in points.items())]
            (info / "entry_points.txt").write_text("\n".join(lines))
            monkeypatch.setenv("PYTHONPATH", str(folder))
        return folder

    return begin


def test_the_commands_to_go_on_with_are_for_a_shell(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit):
        main(["new", "scene", "first_try", "--out", "my scenes/first"])
    assert "quintet run 'my scenes/first/scene.toml'" in capsys.readouterr().out
    (tmp_path / "file").write_text("")
    with pytest.raises(SystemExit) as exit_info:
        main(["new", "scene", "first_try", "--out", "file/first"])
    assert exit_info.value.code == 2
    assert "it cannot be written (Not a directory)" in capsys.readouterr().err


def test_a_new_scene_meets_its_exact_solution(write_start, capsys):
    folder = write_start("scene", "first_try")
    assert "quintet run first_try/scene.toml" in capsys.readouterr().out
    with pytest.raises(SystemExit) as exit_info:
        main(["run", str(folder / "scene.toml"), "--out", str(folder / "run")])
    assert exit_info.value.code == 0
    expectations = results(folder / "run")["expect"]
    assert [outcome["met"] for outcome in expectations] == [True]
    assert results(folder / "run")["scene"] == "first_try"


@pytest.mark.slow
@pytest.mark.parametrize(("template", "name"), [("component", "tether_line"), ("link", "rider")])
def test_a_new_package_passes_its_own_tests(write_start, template, name):
    folder = write_start(template, name)
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(folder)]
    result = subprocess.run(command, cwd=folder, env=os.environ, capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr
    assert f"{2 if template == 'component' else 1} passed" in result.stdout


@pytest.mark.parametrize("template", TEMPLATES)
def test_the_name_of_the_example_is_gone(template):
    example_name = TEMPLATES[template].name
    files = starting_point(template, "brand_new")
    assert "scene.toml" in files
    for path, text in files.items():
        assert example_name not in path
        assert example_name not in text.replace(f"{example_name} lines", "").replace(
            f"{example_name} line", ""
        )
        assert f"class {example_name.capitalize()}" not in text


@pytest.mark.parametrize(
    ("template", "name", "message"),
    [
        ("scene", "two_springs", "a scene that is installed"),
        ("component", "echo", "a component that is installed"),
        ("component", "json", "a module of Python that is installed"),
        ("link", "direct", "a link that is installed"),
        ("link", "class", "no keyword of Python"),
        ("component", "../out", "must be words of lower-case letters"),
        ("component", "my__solver", "joined by single _"),
        ("component", "My-Solver", "must be words of lower-case letters"),
    ],
)
def test_names_that_cannot_be_used_are_refused(tmp_path, template, name, message):
    with pytest.raises(SceneError, match=message):
        write_new(template, name, tmp_path / "new")
    assert list(tmp_path.iterdir()) == []


def test_nothing_is_overwritten(tmp_path):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine/scene.toml").write_text("precious")
    with pytest.raises(SceneError, match="nothing is overwritten"):
        write_new("scene", "mine", tmp_path / "mine")
    assert (tmp_path / "mine/scene.toml").read_text() == "precious"
