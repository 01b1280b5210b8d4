"""Help ends with examples that can be run; a shell completes words of scenes."""

import argparse
import os
import shlex
import subprocess
import sys

import pytest

from quintet.coupler.cli import parser
from quintet.coupler.cli.completion import peers, settings, swaps
from quintet.coupler.cli.examples import EXAMPLES

ASKED = {
    "_ARGCOMPLETE": "1",
    "_ARGCOMPLETE_IFS": "\n",
    "_ARGCOMPLETE_COMP_WORDBREAKS": " \t\n\"'><=;|&(:",
    "COMP_TYPE": "9",
}


def commands():
    (action,) = (
        action for action in parser()._actions if isinstance(action, argparse._SubParsersAction)
    )
    return action.choices


def test_every_command_has_two_examples_at_the_end_of_its_help():
    assert sorted(EXAMPLES) == sorted(commands())
    for name, command in commands().items():
        assert command.format_help().rstrip().endswith("\n  ".join(["examples:", *EXAMPLES[name]]))
        assert len(set(EXAMPLES[name])) == 2


@pytest.mark.parametrize(
    ("name", "line"), [(name, line) for name in EXAMPLES for line in EXAMPLES[name]]
)
def test_examples_are_commands_with_known_options(name, line):
    words = shlex.split(line.partition(" > ")[0])
    assert words[:2] == ["quintet", name]
    options = parser().parse_args(words[1:])
    assert options.command == name


def completed(line, tmp_path):
    """Words that a shell is given for a line."""
    words_file = tmp_path / "words"
    with words_file.open("wb") as file:
        # argcomplete answers on descriptor 8.
        command = f'"{sys.executable}" -m quintet.coupler.cli 8>&{file.fileno()} 9>/dev/null'
        environment = {**os.environ, **ASKED, "COMP_LINE": line, "COMP_POINT": str(len(line))}
        subprocess.run(
            ["bash", "-c", command], env=environment, pass_fds=[file.fileno()], check=True
        )
    return words_file.read_text().split("\n")


def test_a_shell_completes_commands_scenes_and_keys(tmp_path):
    assert [word.strip() for word in completed("quintet mat", tmp_path)] == ["materials"]
    line = "quintet run dam_break_cubes --set components.water.s"
    words = completed(line, tmp_path)
    assert "components.water.spacing=" in words
    assert all(word.startswith("components.water.s") for word in words)


CUBES = argparse.Namespace(scene="dam_break_cubes")
PATHS = [
    ("", "components."),
    ("wind", "window="),
    ("pres", "presets."),
    ("output.int", "output.interval="),
    ("components.", "components.cubes."),
    ("components.wa", "components.water.threads="),
    ("components.water.viscosity.", "components.water.viscosity.kinematic="),
    ("components.cubes.materials.plastic.f", "components.cubes.materials.plastic.friction="),
    ("components.cubes.bodies.0.mat", "components.cubes.bodies.0.material="),
    ("expect.0.wi", "expect.0.within="),
]


@pytest.mark.parametrize(("prefix", "path"), PATHS)
def test_keys_are_completed_one_part_at_a_time(prefix, path):
    words = settings(prefix, CUBES)
    assert path in words
    assert all(word.startswith(prefix) for word in words)


@pytest.mark.parametrize("prefix", ["nothing.", "components.air.", "components.water.kernel.x"])
def test_what_the_scene_does_not_have_is_not_completed(prefix):
    assert settings(prefix, CUBES) == []
    assert settings("components.", argparse.Namespace(scene="none.toml")) == []


def test_components_are_swapped_for_kinds():
    assert set(swaps("", CUBES)) == {"cubes=", "water="}
    assert "water=replay" in swaps("water=", CUBES)


def test_programs_beside_a_scene_are_completed():
    assert peers(argparse.Namespace(scene="dam_break_front")) == ["lammps"]
    assert peers(CUBES) == peers(argparse.Namespace(scene="none.toml")) == []


def test_completion_is_not_imported_by_other_commands():
    program = (
        "import sys; from quintet.coupler.cli import parser; parser().format_help(); "
        "print([name for name in sys.modules if 'argcomplete' in name or 'completion' in name])"
    )
    words_file = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert words_file.stdout.strip() == "[]"
