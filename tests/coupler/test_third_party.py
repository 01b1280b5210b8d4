"""Packages of third parties, outside the repository: found by entry points, run as ours are.

One is a class that an entry point names; the other, from a text, has a manifest.
"""

import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from quintet.coupler.files.recording import Recording
from quintet.scenarios.two_springs import springs

ROOT = Path(__file__).resolve().parents[2]
FILES = re.compile(r"`([\w/]+\.(?:py|toml))`:\n\n```\w+\n(.*?)^```$", re.MULTILINE | re.DOTALL)
OVER = [pytest.param("zenoh", marks=pytest.mark.zenoh), pytest.param("mpi", marks=pytest.mark.mpi)]

PROJECT = """
[build-system]
requires = ["setuptools>=77"]
build-backend = "setuptools.build_meta"

[project]
name = "swing"
version = "0.1"
dependencies = ["quintet"]

[project.entry-points."quintet.components"]
swing = "swing:Swing"
adapter = "adapter:Adapter"

[tool.setuptools]
py-modules = ["swing", "adapter"]
"""
CASES = '''

class Swing(Mass):
    """A mass on a spring, on the ground."""

    @staticmethod
    def conform_cases():
        """A mass at rest, with and without a ground that moves."""
        from quintet.interfaces.manifest import ConformCase

        nothing = np.zeros((1, 3))
        ground = {"foot.position": nothing, "foot.velocity": nothing}
        params = {"mass": 1.0, "stiffness": 9.0, "arm": [0.0, 0.0, 1.0], "start": [0.0, 0.0, 1.0]}
        scale = {"load.force": 5.0, "foot.position": 0.1}
        return (ConformCase("alone", params),
                ConformCase("ridden", params, rest={"load.force": nothing, **ground}, scale=scale))
'''
ADAPTER = '''
"""A program of its own, started again for every step, moves it on by a metre."""

import subprocess
import sys

import numpy as np

from quintet.interfaces.component import Component, Port
from quintet.interfaces.params import NotNegative, parameters
from quintet.interfaces.ports import POSITION

PROGRAM = """
import sys, time
way, seconds, x = sys.argv[1], *map(float, sys.argv[2:])
end = time.monotonic() + seconds
while time.monotonic() < end:
    time.sleep(1.0 if way == "waits" else 0.0)
print(x + 1.0)
"""


class Adapter(Component):
    """What a program computes."""

    takes = ()
    gives = (Port("motion", (POSITION,)),)

    @parameters
    class Params:
        """How long its program takes.

        Parameters
        ----------
        seconds : s
            Of the clock, for each step.
        way
            Whether the program computes all the time, or waits.
        """

        seconds: NotNegative
        way: str = "computes"

    def __init__(self, params):
        self.params, self.x = params, 0.0

    def stable_dt(self):
        return 1.0

    def take(self, fields):
        pass

    def step(self, dt):
        words = [self.params.way, str(self.params.seconds), str(self.x)]
        line = [sys.executable, "-c", PROGRAM, *words]
        self.x = float(subprocess.run(line, check=True, capture_output=True, text=True).stdout)

    def give(self, wanted):
        return {"motion.position": np.full((1, 3), self.x)} if wanted else {}

    def save(self):
        return {"x": np.array(self.x)}

    def load(self, state):
        self.x = float(state["x"])
'''
ADAPTED = """
name = "adapted"
end = 2.0
window = 1.0
transport = "{transport}"
output.fields = ["program.motion.position"]
[components.program]
kind = "adapter"
seconds = {seconds}
way = "{way}"
"""


def swings(folder):
    """Write a package of two modules, and a scene of two swings, one on the other."""
    package = folder / "swing"
    package.mkdir()
    (package / "pyproject.toml").write_text(PROJECT)
    (package / "swing.py").write_text(Path(springs.__file__).read_text() + CASES)
    (package / "adapter.py").write_text(ADAPTER)
    scene = Path(springs.__file__).with_name("scene.toml").read_text()
    (folder / "swings.toml").write_text(scene.replace("springs:Mass", "swing"))
    return package


def moorings(folder):
    """Write the package of a text, and its scene."""
    package = folder / "mooring"
    for name, content in FILES.findall((ROOT / "interfaces/README.md").read_text()):
        path = folder / "hanging.toml" if name == "scene.toml" else package / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content)
    return package


def unpack(package):
    """Lay a package out as pip would; return the folder that has it."""
    project = tomllib.loads((package / "pyproject.toml").read_text())["project"]
    info_folder = package / f"{project['name']}-{project['version']}.dist-info"
    info_folder.mkdir()
    (info_folder / "METADATA").write_text(
        f"Name: {project['name']}\nVersion: {project['version']}\n"
    )
    lines = []
    for group, points in project["entry-points"].items():
        lines += [f"[{group}]", *(f"{key} = {value}" for key, value in points.items())]
    (info_folder / "entry_points.txt").write_text("\n".join(lines))
    return str(package)


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """A function that runs quintet with two further packages on its path."""
    folder = tmp_path_factory.mktemp("outside")
    paths = [unpack(package) for package in (swings(folder), moorings(folder))]
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(paths), "PYTHONSAFEPATH": "1"}

    def quintet(*words, seconds=120):
        line = [sys.executable, "-m", "quintet.coupler.cli", *map(str, words)]
        return run(line, folder, env, seconds)

    return quintet


@pytest.fixture(scope="module")
def by_pip(tmp_path_factory):
    """Quintet and the two packages, installed into an environment of their own."""
    folder = tmp_path_factory.mktemp("environment")
    bin = folder / "venv/bin"
    env = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    subprocess.run([sys.executable, "-m", "venv", folder / "venv"], check=True)
    hidden = [path.name for path in ROOT.glob(".*") if path.name != ".package"]
    ignored = shutil.ignore_patterns(*hidden, "build", "runs", "tests", "*.egg-info")
    shutil.copytree(ROOT, folder / "quintet", ignore=ignored, symlinks=True)
    packages = [f"{folder / 'quintet'}[mpi,zenoh]", swings(folder), moorings(folder)]
    subprocess.run([bin / "pip", "install", "--quiet", *packages], check=True, env=env)

    def quintet(*words, seconds=120):
        return run([bin / "quintet", *map(str, words)], folder, env, seconds)

    return quintet


def run(line, folder, env, seconds):
    result = subprocess.run(
        line, cwd=folder, env=env, capture_output=True, text=True, timeout=seconds
    )
    return result.returncode, result.stdout + result.stderr, folder


def test_an_entry_point_to_a_class_is_checked_described_and_conforms(installed):
    status, output, _ = installed("check", "swings.toml")
    assert status == 0 and "lower takes load (force [N, impulse])" in output
    status, output, _ = installed("describe", "swing")
    assert status == 0 and output.startswith("swing: A mass on a spring, on the ground\n")
    status, output, _ = installed("conform", "swing")
    assert status == 0 and "swing conforms; " in output, output


@pytest.mark.zenoh
@pytest.mark.mpi
def test_a_class_runs_over_every_transport_to_the_same_bits(installed):
    for transport in ("memory", "zenoh", "mpi"):
        words = ("--transport", transport, "--set", "end=0.1", "--out", f"swings-{transport}")
        status, output, _ = installed("run", "swings.toml", *words)
        assert status == 1 and "swings" in output, output  # too short for the expectations at 1 s
        if transport != "memory":
            assert installed("diff", "swings-memory", f"swings-{transport}")[0] == 0


@pytest.mark.parametrize("transport", OVER)
def test_a_manifest_of_a_package_runs_and_conforms(installed, transport):
    words = ("--transport", transport, "--out", f"hanging-{transport}")
    status, output, _ = installed("run", "hanging.toml", *words)
    assert status == 0, output


@pytest.mark.parametrize("transport", OVER)
@pytest.mark.full
def test_packages_installed_by_pip_run_and_conform(by_pip, transport):
    for scene in ("swings", "hanging"):
        words = ("--transport", transport, "--out", f"{scene}-{transport}")
        status, output, _ = by_pip("run", f"{scene}.toml", *words)
        assert status == 0, output
    for kind in ("swing", "mooring"):
        status, output, _ = by_pip("conform", kind)
        assert status == 0 and f"{kind} conforms" in output, output
    assert "mooring" in by_pip("describe")[1]


def positions_of(quintet, transport, seconds, way):
    """Positions of a component whose every step waits for a program."""
    folder = quintet("--version")[2]
    name = f"{way}-{transport}-{seconds}"
    scene = folder / f"{name}.toml"
    scene.write_text(ADAPTED.format(transport=transport, seconds=seconds, way=way))
    status, output, _ = quintet("run", scene.name, "--out", name, seconds=4 * seconds + 60)
    assert status == 0, output
    with Recording(folder / name) as recording:
        return recording.history("program", "motion.position", 0)[:, 0].tolist()


@pytest.mark.zenoh
def test_a_step_may_run_a_program(installed):
    assert positions_of(installed, "zenoh", 1, "waits") == [0.0, 1.0, 2.0]


@pytest.mark.full
@pytest.mark.parametrize("transport", OVER)
@pytest.mark.parametrize("way", ["computes", "waits"])
def test_a_step_may_run_a_program_for_half_a_minute(installed, transport, way):
    assert positions_of(installed, transport, 30, way) == [0.0, 1.0, 2.0]
