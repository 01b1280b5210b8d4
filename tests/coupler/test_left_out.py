"""No process imports a component or library that the scene does not need."""

import json
import os
import subprocess
import sys

import pytest
from started import Started, write_scene

from quintet.coupler.scene.read import library

HEAVY = {"zenoh", "cryptography", "mpi4py", "matplotlib", "scipy", "vtk", "numba"}
ALONE = """
name = "alone"
end = 0.01
window = 1e-3
transport = "memory"
[components.{name}]
kind = "{kind}"
{settings}
"""
MAIN = """
import json, os, sys
from quintet.coupler.cli import main
try:
    main(sys.argv[1:])
except SystemExit as ended:
    with open(os.environ["FOUND"], "w") as file:
        json.dump([ended.code, sorted(sys.modules)], file)
"""
CHECKS = """
import json, os, sys
from quintet.coupler.cli import main
found, seen = {}, set()
for name in sys.argv[1:]:
    try:
        main(["check", name])
    except SystemExit as ended:
        found[name] = ended.code, sorted(set(sys.modules) - seen)
    seen = set(sys.modules)
with open(os.environ["FOUND"], "w") as file:
    json.dump(found, file)
"""
SPY = """
import os, sys
from toys import Toy
class Spy(Toy):
    '''Writes down what its process imported.'''
    def totals(self):
        with open(os.environ["SEEN"], "w") as file:
            file.write(" ".join(sys.modules))
        return super().totals()
"""


def fresh(tmp_path, program, *arguments):
    """Run a program in a fresh interpreter; return its findings and its errors."""
    path = tmp_path / "modules.json"
    result = subprocess.run(
        [sys.executable, "-c", program, *arguments],
        env={**os.environ, "FOUND": str(path)},
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=120,
    )
    return json.loads(path.read_text()), result.stderr


def modules(tmp_path, *arguments):
    """Run the command line in a fresh interpreter; return the imported modules."""
    (status, names), errors = fresh(tmp_path, MAIN, *arguments)
    assert status == 0, errors
    return set(names)


def solvers(names):
    """Solver packages, and their modules other than manifests."""
    parts = [name.split(".") for name in names if name.startswith("quintet.components.")]
    parts = [part for part in parts if part[2] != "shared"]
    return {part[2] for part in parts}, {part[3] for part in parts if len(part) > 3}


def test_one_component_in_memory_imports_no_transport_and_no_other_solver(tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text(ALONE.format(name="echo", kind="echo", settings="items = 3"))
    names = modules(tmp_path, "run", str(scene))
    assert not names & HEAVY
    assert not names & {"quintet.interfaces.lines.zenoh", "quintet.interfaces.lines.mpi"}
    assert solvers(names) == ({"stand_ins"}, {"params", "recorded", "echo"})
    links = {name for name in names if name.startswith("quintet.coupler.coupling.links.")}
    assert links <= {"quintet.coupler.coupling.links.keys"}  # modules that all of them load


def test_a_scene_imports_the_component_that_it_names_and_no_other(tmp_path):
    settings = 'bodies = [{shape = "box", lowest = [0, 0, 0], highest = [1, 1, 1]}]'
    scene = tmp_path / "scene.toml"
    scene.write_text(ALONE.format(name="box", kind="prescribed", settings=settings))
    names = modules(tmp_path, "run", str(scene))
    assert not names & HEAVY
    assert solvers(names) == ({"stand_ins"}, {"params", "recorded", "prescribed"})


@pytest.mark.zenoh
def test_the_coupler_of_several_processes_imports_no_solver(tmp_path):
    scene = tmp_path / "scene.toml"
    text = ALONE.format(name="ping", kind="echo", settings="items = 3")
    text += '[components.pong]\nkind = "echo"\nitems = 3\n[[links]]\nkind = "direct"\n'
    text += 'pairs = [["ping.returned", "pong.passed"], ["pong.returned", "ping.passed"]]\n'
    scene.write_text(text)
    names = modules(tmp_path, "run", str(scene), "--transport", "zenoh")
    assert "zenoh" in names and not names & (HEAVY - {"zenoh", "cryptography"})
    assert "quintet.coupler.launch.certificates" not in names
    assert solvers(names) == ({"stand_ins"}, {"params", "recorded"})
    assert "quintet.interfaces.lines.memory" not in names
    restarts = {f"quintet.coupler.launch.{part}" for part in ("restartable_line", "order_log")}
    assert not restarts & names
    assert not {name for name in names if name.startswith("quintet.coupler.chaos")}
    hosts = {
        "coupler.launch.remote_host",
        "interfaces.lines.signs",
        "interfaces.lines.line_elsewhere",
    }
    assert not {f"quintet.{part}" for part in hosts} & names


# For trimesh, which reads a hull, pint, which knows the units in the heads of a table, and the
# overlaps of thousands of spheres.
NEED_SCIPY = ("column_collapse", "floating_hull", "hull_in_waves", "spheric_10")


@pytest.fixture(scope="module")
def checked_scenes(tmp_path_factory):
    """Check all scenes one by one; return the status of each, and the modules it first imported."""
    names = sorted(library(), key=lambda name: (name in NEED_SCIPY, name))
    return fresh(tmp_path_factory.mktemp("checked"), CHECKS, *names)[0]


@pytest.mark.parametrize("name", library())
def test_checking_a_scene_imports_no_solver_and_no_transport(checked_scenes, name):
    status, names = checked_scenes[name]
    assert status == 0
    assert set(names) & {*HEAVY, "h5py"} <= ({"scipy"} if name in NEED_SCIPY else set())
    assert not solvers(names)[1] & {"component", "kernels", "laws"}


@pytest.mark.zenoh
def test_a_component_imports_neither_coupler_nor_another_transport(tmp_path, monkeypatch):
    names_file = tmp_path / "seen"
    monkeypatch.setenv("SEEN", str(names_file))
    path = write_scene(tmp_path, "zenoh", 0.01)
    (tmp_path / "spy.py").write_text(SPY)
    path.write_text(path.read_text().replace('pong]\nkind = "toys:Toy"', 'pong]\nkind = "spy:Spy"'))
    run = Started(path)
    assert run.wait() == 0, run.err
    names = set(names_file.read_text().split())
    assert "zenoh" in names
    assert not names & {"mpi4py", "matplotlib", "h5py", "rich", "numba"}
    assert not {name for name in names if name.startswith("quintet.coupler")}
    assert solvers(names) == (set(), set())
