"""The definitions of the images copy what an installation needs, and their commands are there."""

import re
import shlex
import tomllib
from pathlib import Path

from quintet.coupler import cli

ROOT = Path(__file__).resolve().parents[1]
SECTIONS = dict(
    re.findall(r"^%(\w+)\n(.*?)(?=^%|\Z)", (ROOT / ".package/quintet.def").read_text(), re.M | re.S)
)
DOCKER = (ROOT / ".package/Dockerfile").read_text()


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


def test_the_image_for_docker_copies_and_runs_the_same():
    copied = {}
    for line in re.findall(r"^COPY (.+)$", DOCKER, re.M):
        *paths, target = line.split()
        ends = [target + path if target.endswith("/") else target for path in paths]
        copied |= dict(zip(paths, ends, strict=True))
    assert copied == dict(line.split() for line in SECTIONS["files"].split("\n") if line.strip())
    run = re.search(r"^RUN (.+?)\n\n", DOCKER, re.M | re.S)[1].replace(" \\\n   ", "")
    commands = [command.strip() for command in run.split("&&")]
    assert commands[:-1] == [line.strip() for line in SECTIONS["post"].strip().split("\n")]
    assert commands[-1].startswith("find /opt/quintet -type d -name __pycache__ -exec chmod a+rwx")
