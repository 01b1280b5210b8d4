"""The definition of the image copies what an installation needs, and its commands are there."""

import re
import shlex
import tomllib
from pathlib import Path

from quintet.coupler import cli

ROOT = Path(__file__).resolve().parents[1]
SECTIONS = dict(
    re.findall(r"^%(\w+)\n(.*?)(?=^%|\Z)", (ROOT / ".package/quintet.def").read_text(), re.M | re.S)
)


def test_all_that_is_copied_is_there_and_nothing_of_the_package_lacks():
    copied = dict(line.split() for line in SECTIONS["files"].split("\n") if line.strip())
    assert [path for path in copied if not (ROOT / path).exists()] == []
    links = (path.resolve() for path in (ROOT / ".package/quintet").iterdir())
    folders = {link.relative_to(ROOT).parts[0] for link in links if ROOT in link.parents}
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    needed = {*folders, ".package", "pyproject.toml", project["readme"], *project["license-files"]}
    assert needed - copied.keys() == set()


def test_its_commands_are_those_of_the_command_line():
    text = SECTIONS["post"] + SECTIONS["test"]
    commands = re.findall(r"/bin/quintet (.+)", text)
    assert [command.split()[0] for command in commands] == ["compile", "run"]
    for command in commands:
        cli.parser().parse_args(shlex.split(command))


def test_it_is_installed_with_the_versions_that_were_measured():
    assert '-c /source/constraints.txt "/source[all]"' in SECTIONS["post"]
