"""`quintet compile` fills the caches: a run that follows compiles nothing."""

import os
import subprocess
import sys

import pytest
from spring_scene import write

from quintet.coupler.cli import main
from quintet.coupler.run import compilation
from quintet.coupler.run.compilation import scenes_of
from quintet.interfaces.errors import SceneError


def _quintet(folder, *arguments):
    command = [sys.executable, "-m", "quintet.coupler.cli", *map(str, arguments)]
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(folder / "cache")}
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)


def _compiled(folder):
    return {path.name: path.stat().st_mtime_ns for path in folder.rglob("*.nbc")}


@pytest.mark.slow
def test_a_run_after_compile_compiles_nothing(tmp_path):
    result = _quintet(tmp_path, "compile", "heated_slab")
    assert result.returncode == 0 and "compiled in" in result.stdout
    compiled_files = _compiled(tmp_path / "cache")
    assert compiled_files and [path.name for path in tmp_path.iterdir()] == ["cache"], (
        "no run is left"
    )
    result = _quintet(tmp_path, "run", "heated_slab", "--transport", "memory", "--out", "run")
    assert result.returncode == 0, result.stderr
    assert _compiled(tmp_path / "cache") == compiled_files


def test_kinds_stand_for_the_scenes_that_use_them():
    assert scenes_of(["fe_heat"]) == ["heated_slab", "hot_bar_coupled", "hot_bar_elements"]
    assert scenes_of(["two_springs", "fe_heat"])[0] == "two_springs"
    assert len(scenes_of([])) > 40
    with pytest.raises(SceneError, match=r"compile two_spring is not known\. Did you mean"):
        scenes_of(["two_spring"])


def test_a_scene_file_is_compiled_too(tmp_path, capsys):
    with pytest.raises(SystemExit) as exit_info:
        main(["compile", str(write(tmp_path))])
    assert exit_info.value.code == 0 and "spring" in capsys.readouterr().out


def test_a_scene_whose_compilation_is_killed_is_not_compiled(monkeypatch, capsys):
    program = [sys.executable, "-c", "import os, signal; os.kill(os.getpid(), signal.SIGKILL)"]
    monkeypatch.setattr(compilation, "PYTHON", program)
    with pytest.raises(SystemExit) as exit_info:
        main(["compile", "two_springs", "heated_slab"])
    assert exit_info.value.code == 137
    assert "compile heated_slab was killed by signal 9 (SIGKILL)" in capsys.readouterr().err
