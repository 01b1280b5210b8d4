"""A scene of one spring, ω = 10 rad/s, and commands that read it."""

import json
import shutil
from pathlib import Path

import pytest

from quintet.coupler.cli import main

SCENE = """
name = "spring"
end = 1.0
transport = "memory"
[components.spring]
kind = "toy_spring:Spring"
step = 0.02
mass = 1.0
stiffness = 100.0
[[expect]]
name = "end"
component = "spring"
field = "motion.position"
axis = 0
measure = "at"
begin = 1.0
value = -0.8390715290764524
within = {within}
unit = "m"
source = "cos(10)"
"""
CURVE = """
[[expect]]
name = "curve"
component = "spring"
field = "motion.position"
axis = 0
measure = "rms"
csv = "cosine.csv"
within = 0.05
unit = "m"
source = "cos(10 t)"
"""


def write(folder, more="", within=2e-3):
    shutil.copy(Path(__file__).with_name("toy_spring.py"), folder)
    path = folder / "scene.toml"
    path.write_text(SCENE.format(within=within) + more)
    return path


def command(*arguments):
    """Exit status of a command."""
    with pytest.raises(SystemExit) as exit_info:
        main([str(argument) for argument in arguments])
    return exit_info.value.code


def command_json(name, path, *arguments):
    """Run a command that writes JSON; return its exit status and the JSON."""
    file = path.parent / "found.json"
    out = path.parent / "all"
    status = command(name, path, "--out", out, "--json", file, *arguments)
    return status, json.loads(file.read_text())
