"""The check of a scene refuses an impossible run: status 2, and one complete sentence."""

import platform
import shutil
import socket
import subprocess

import psutil
import pytest
from started import write_scene

from quintet.coupler.cli import main

HUGE = "must be below 1e+30 in size, in SI units; found"
BODY, CUBE = "components.spheres.bodies.0", "components.cube.bodies.0"


def box_settings(body, lowest, highest):
    """Settings that put a box elsewhere."""
    return ["--set", f"{body}.lowest={lowest}", "--set", f"{body}.highest={highest}"]


CUBE_IN_WATER = box_settings(CUBE, "[0.15,0.15,0.125]", "[0.3,0.3,0.275]")
CASES = {
    "components that are none": (
        ["two_springs", "--set", "components=5"],
        "components must be tables; found 5. Write [components.NAME].",
    ),
    "a component in the place of a kind": (
        ["two_springs", "--swap", "lower=upper"],
        "--swap lower=upper: what takes the place of lower must be a kind; found upper, a component"
        " of this scene. Name its kind, 'springs:Mass', or another.",
    ),
    "a list in the place of a port": (
        ["two_springs", "--set", 'links.0.pairs=[[[], "lower.load"]]'],
        "links.0.pairs must be pairs of ports, the giver first, as in "
        """[["a.motion", "b.foot"]]; found [[[], 'lower.load']]. Name both of each.""",
    ),
    "a set of nodes that is nowhere": (
        ["cantilever", "--set", 'components.beam.fixed=[{node_set="clmp"}]'],
        "components.beam: fixed.0: node_set clmp is not known. Did you mean clamp?",
    ),
    "a set of heated nodes that is nowhere": (
        ["heated_slab", "--set", 'components.slab.coupled_faces=[{node_set="top"}]'],
        "components.slab: coupled_faces.0: node_set top is not known.",
    ),
    "a gauge of a set that is nowhere": (
        ["cantilever", "--set", 'components.beam.gauges.node_set_gauges=["nix"]'],
        "components.beam: gauges.node_set_gauges.0: node_set nix is not known.",
    ),
    "a line of a body that is missing": (
        ["moored_buoy", "--set", "components.chains.lines.1.body=3"],
        "components.chains: lines.1.body must be below 1, the number of bodies that links bring; "
        "found 3. Correct it.",
    ),
    "a link of motion without loads": (
        ["moored_buoy", "--set", 'links.0.pairs=[["buoy.motion", "chains.motion"]]'],
        "components.chains: links must join both motion and load of mooring lines; load has no "
        "partner. Add a pair for it to the link.",
    ),
    "no pairs": (["two_springs", "--set", "links.0.pairs=[]"], "links.0.pairs must be pairs of"),
    "lists in the place of components": (
        ["floating_cube", "--set", "links.0.between=[[], []]"],
        "links.0.between must name two components; found [[], []]. Name both.",
    ),
    "a number for a link's name": (
        ["two_springs", "--set", "links.0.name=3"],
        "links.0.name should be a valid string; found 3. Correct it.",
    ),
    "a size of 1e30": (
        ["sphere_rebound", "--set", f"{BODY}.radius=1e30"],
        f"{BODY}.radius {HUGE} 1e+30. Correct it.",
    ),
    "an end of 1e300": (["two_springs", "--set", "end=1e300"], f"end {HUGE} 1e+300. Correct it."),
    "a stiffness of 1e308": (
        ["sphere_rebound", "--set", "components.spheres.materials.glass.youngs_modulus=1e308"],
        f"components.spheres.materials.glass.youngs_modulus {HUGE} 1e+308. Correct it.",
    ),
    "a whole number of 4000 digits": (
        ["two_springs", "--set", f"components.lower.mass=1{4000 * '0'}"],
        f"components.lower.mass {HUGE} about 1e4000. Correct it.",
    ),
    "lists without end": (
        ["two_springs", "--set", f"components.lower.mass={40 * '['}{40 * ']'}"],
        "is deeper. Flatten it.",
    ),
    "an end without number of windows": (
        ["two_springs", "--set", "end=1e20"],
        "scene.end must be at most 9e+15 windows; found 1e+20 s, of windows of 0.002 s. End "
        "earlier, or lengthen scene.window.",
    ),
    "an end without number of steps": (
        ["still_water", "--set", "end=1e20", "--set", "window=1e20"],
        "components.water: it must come to scene.end, 1e+20 s, in at most 9e+15 steps; its step",
    ),
    "numbers that leave what can be computed": (
        ["sphere_rebound", "--set", f"{BODY}.radius=1e-200"],
        "components.spheres: its numbers must be such that what follows from them can be computed;",
    ),
    "threads without number": (
        ["still_water", "--set", "components.water.threads=100000"],
        "components.water.threads should be less than or equal to 1024; found 100000. Correct it.",
    ),
    "a port without number": (
        ["two_springs", "--set", "endpoint=tcp/127.0.0.1:99999"],
        "scene.endpoint 'tcp/127.0.0.1:99999': the port must be from 1 to 65535; found 99999. "
        "Choose one that is free, or give no endpoint.",
    ),
    "mm in the place of m": (
        ["two_springs", "--set", "expect.0.unit=mm"],
        "expectation lower.end: unit must be m, that of motion.position; found 'mm'. Give value "
        "and within in m, or the scale that makes mm of m.",
    ),
    "a crossing in m": (
        ["dam_break_cubes", "--set", "expect.1.unit=m"],
        "expectation top_cube.fall: unit must be s, that of crossing; found 'm'. Give value and "
        "within in s.",
    ),
    "1e9 particles": (
        ["still_water", "--set", "components.water.spacing=2e-5", "--set",
         "components.water.dimensions=3", "--set", "window=1e-2"],
        "components must fit into this machine's memory of ",
    ),
}  # fmt: skip
# Mistakes that components find when they are joined, before the first window.
MISPLACED = {
    "in the water": (
        ["floating_cube", *CUBE_IN_WATER],
        "components.water: body 0 must begin outside the water; its sample at (",
    ),
    "outside the tank": (
        ["floating_cube", *box_settings(CUBE, "[0.45,0.15,0.325]", "[0.6,0.3,0.475]")],
        "m beyond face x+. Move it, or open that face.",
    ),
    "a square in the water": (
        ["floating_square", "--set", "components.square.bodies.0.origin=[0.225,0.5,0.2]"],
        "components.water: body 0 must begin outside the water; its sample at (",
    ),
    "thinner than the spacing": (
        ["floating_cube", *box_settings(CUBE, "[0.2,0.2,0.3]", "[0.21,0.21,0.31]")],
        "components.cube: a body must be at least ",
    ),
    "in a slab of another thickness": (
        ["floating_square", "--set",
         "components.water.fluid=[{lowest=[0,0,0],highest=[0.45,0.5,0.2]}]",
         "--set", "components.water.boundary.walls={lowest=[0,0,0],highest=[0.45,0.5,0.45]}"],
        "in two dimensions samples stand for 1 m along y, and so must the fluid",
    ),
}  # fmt: skip


@pytest.fixture(autouse=True)
def nothing_starts(monkeypatch, tmp_path):
    platform.processor()  # kept from then on; h5py asks for it, which starts a process

    def refuse(*arguments, **settings):
        raise AssertionError("a process was started")

    monkeypatch.setattr(subprocess.Popen, "__init__", refuse)
    monkeypatch.chdir(tmp_path)


def refusal(capsys, *arguments):
    """The one sentence of a command that ends with status 2."""
    with pytest.raises(SystemExit) as exit_info:
        main(arguments)
    assert exit_info.value.code == 2
    lines = [line for line in capsys.readouterr().err.splitlines() if line]
    assert len(lines) == 1, lines
    return lines[0]


@pytest.mark.parametrize("case", CASES)
def test_what_cannot_be_run_is_told_in_one_sentence_as_a_scene_is_checked(capsys, case):
    arguments, words = CASES[case]
    message = refusal(capsys, "check", *arguments)
    assert message.startswith("quintet: scene.toml: ") and words in message
    assert refusal(capsys, "run", *arguments) == message


@pytest.mark.parametrize("case", MISPLACED)
def test_bodies_that_are_out_of_place_are_refused_before_the_first_window(capsys, case):
    arguments, words = MISPLACED[case]
    assert words in refusal(capsys, "run", *arguments)


def test_memory_that_is_not_there_is_planned_without_being_used(capsys):
    """Eight million bodies, and more particles than any machine holds, in obstacles too."""
    memory = psutil.Process().memory_info().rss
    block = "[{lowest=[0.2,0.0,0.2],highest=[0.4,0.2,0.4]}]"
    spacing = ["still_water", "--set", "components.water.spacing=1e-5"]
    refusal(capsys, "check", *spacing, "--set", "components.water.dimensions=3", "--set",
            f"components.water.boundary.obstacles={block}", "--set",
            "components.water.fluid=[{lowest=[0,0,0],highest=[0.1,0.2,0.5]}]")  # fmt: skip
    copies = "{number=[200,200,200],spacing=[0.013,0.013,0.0125]}"
    settings = ["--set", f"components.spheres.bodies.0.copies={copies}"]
    with pytest.raises(SystemExit):
        main(["check", "settling_packing", "--set", "components.spheres.planes=[]", *settings])
    assert psutil.Process().memory_info().rss - memory < 100e6


@pytest.mark.parametrize("template", ["tcp/127.0.0.1:{port}", "tcp/localhost:{port}"])
def test_a_port_that_another_uses_is_told_before_anything_starts(capsys, tmp_path, template):
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        listener.listen()
        endpoint = template.format(port=listener.getsockname()[1])
        message = refusal(capsys, "run", "two_springs", "--set", f"endpoint={endpoint}")
    assert message == (
        f"quintet: scene.endpoint {endpoint}: the coupler must be able to listen there; it cannot "
        "(Address already in use). End what uses the port, name another, or give no endpoint."
    )
    assert not list(tmp_path.iterdir())


def test_a_folder_that_is_a_file_or_cannot_be_written_is_told(capsys, tmp_path):
    file = tmp_path / "file"
    file.write_text("mine")
    message = refusal(capsys, "run", "two_springs", "--out", str(file))
    assert message == f"quintet: --out {file}: it must be a folder; it is a file. Name another."
    message = refusal(capsys, "run", "two_springs", "--out", str(file / "below"))
    assert "it cannot be written (Not a directory). Name another folder." in message
    message = refusal(capsys, "run", "two_springs", "--out", "/proc/none")
    assert "it cannot be written (No such file or directory). Name another folder." in message
    assert file.read_text() == "mine" and len(list(tmp_path.iterdir())) == 1


def run_scene(folder, *arguments):
    with pytest.raises(SystemExit) as exit_info:
        main(["run", str(folder / "scene.toml"), *arguments])
    return exit_info.value.code


def test_a_replay_of_a_run_that_does_not_fit_is_told_as_the_scene_is_checked(capsys, tmp_path):
    write_scene(tmp_path, end=0.1)
    assert run_scene(tmp_path, "--out", "one") == 0
    capsys.readouterr()
    replay = [str(tmp_path / "scene.toml"), "--swap", "pong=replay@one"]
    rule = "components.pong: a replay can give at the times of its recording only"
    message = refusal(capsys, "check", *replay, "--set", "end=0.2")
    assert f"{rule}, which ends at 0.1 s; scene.end is 0.2 s. End there, replay a longer" in message
    message = refusal(capsys, "check", *replay, "--set", "window=7e-4")
    assert (
        f"{rule}; this run has 143 windows of 0.000699301 s, the recording 100 windows" in message
    )
    assert "(of 0.001 s). Set scene.window to that of the recorded run" in message
    message = refusal(capsys, "check", *replay, "--set", "window=3e-3")
    assert "the recording none at 0.00294118 s" in message
    assert run_scene(tmp_path, *replay[1:], "--set", "end=0.05", "--out", "two") == 0
    assert run_scene(tmp_path, *replay[1:], "--set", "window=2e-3", "--out", "three") == 0


def test_a_short_replay_is_not_held_against_longer_refinements(tmp_path):
    path = write_scene(tmp_path, end=0.1)
    refinement = '\n[[study]]\nlabel = "long"\nsettings = { end = 0.3 }\n'
    path.write_text(path.read_text() + refinement)
    assert run_scene(tmp_path, "--out", "one") == 0
    assert run_scene(tmp_path, "--swap", "pong=replay@one", "--out", "two") == 0


def test_a_replay_without_a_run_is_of_the_latest_one(capsys, tmp_path):
    write_scene(tmp_path, end=0.02)
    runs = tmp_path / "runs"
    for number in range(3):
        assert run_scene(tmp_path, "--set", f"end={0.02 + 0.01 * number}") == 0
    shutil.copytree(runs / "toy-3", runs / "toy-10")
    (runs / "toy-11").mkdir()  # of no run
    shutil.copytree(runs / "toy", runs / "toy-12")
    marker = (runs / "toy-12" / "quintet-run.json").read_text()
    (runs / "toy-12" / "quintet-run.json").write_text(marker.replace('"toy"', '"toy-12"'))
    capsys.readouterr()
    with pytest.raises(SystemExit) as exit_info:
        main(["run", str(tmp_path / "scene.toml"), "--swap", "pong=replay", "--set", "end=0.04"])
    assert exit_info.value.code == 0
    resolved = (runs / "toy-4" / "scene.toml").read_text()
    assert f'recording = "{runs / "toy-10"}"' in resolved


def test_water_that_leaves_room_for_bodies_may_hold_them(capsys):
    """A refusal names the key that helps: with this key the same scene is sound."""
    arguments = ["floating_cube", *CUBE_IN_WATER]
    assert "or set remove_inside_bodies = true." in refusal(capsys, "run", *arguments)
    with pytest.raises(SystemExit) as exit_info:
        main(["check", *arguments, "--set", "components.water.remove_inside_bodies=true"])
    assert exit_info.value.code == 0


def test_a_sentence_is_no_longer_than_a_few_lines_whatever_names_are_in_it(capsys):
    message = refusal(
        capsys, "check", "two_springs", "--set", f"components.lower.kind={'x' * 9000}"
    )
    assert (
        len(message) < 2100 and "components.lower.kind xxx" in message and "Known here: " in message
    )
