"""A component whose process dies is started again, and the run ends with the same bits."""

import re
import shutil
from functools import cache
from pathlib import Path

import pytest
from chain_scene import write
from started import TOYS, Started, same, write_scene
from toy_faults import OUTLIVES

from quintet.coupler.cli import main

pytestmark = pytest.mark.zenoh
DIED = "was killed by signal 9 (SIGKILL)"
MOMENTS = {
    "build": ("build", 0),
    "first window": ("step", 0),
    "later window": ("step", 121),
    "between": ("between", 121),
    "snapshot": ("save", 79),
    "end": ("finish", 0),
}
BY_DEFAULT = ("first window", "later window", "snapshot")
SERIAL = [
    moment if moment in BY_DEFAULT else pytest.param(moment, marks=pytest.mark.full)
    for moment in MOMENTS
]
OTHER_SCHEMES = [
    ("later window", "parallel"),
    ("between", "iterated"),
    pytest.param("between", "parallel", marks=pytest.mark.full),
    pytest.param("later window", "iterated", marks=pytest.mark.full),
]

SNAPSHOTS = ("--set", "output.snapshots=0.04")


@pytest.fixture(scope="module")
def mortal(tmp_path_factory):
    """Start a scene whose second component dies at a given moment."""
    started = []

    def start(pong="", restarts=2, ping="", arguments=()):
        folder = tmp_path_factory.mktemp("run")
        shutil.copy(TOYS.with_name("toy_faults.py"), folder)
        keys = f'substeps = 2\nmoment = "{folder / "deaths"}"\n{pong}'
        if "fails_by" not in pong:
            keys += '\nfails_by = "SIGKILL"'
        if "times" not in pong:
            keys += "\ntimes = 1"
        scene = write_scene(folder, "zenoh", 0.1, ping, keys)
        text = "toy_faults:Faulty".join(scene.read_text().rsplit("toys:Toy", 1))
        scene.write_text(f"restarts = {restarts}\n{text}")
        started.append(Started(scene, *arguments))
        return started[-1]

    yield start
    for run in started:
        run.end()


@pytest.fixture(scope="module")
def undisturbed(mortal):
    """Folder of a run of a scheme without a death, and without restarts."""

    @cache
    def run(scheme):
        reference = mortal(restarts=0, arguments=("--set", f'scheme="{scheme}"', *SNAPSHOTS))
        assert reference.wait() == 0, reference.err
        return reference.folder

    return run


def check_restarted(run, times=1):
    """The run came to its end, reported the restarts, and left nothing."""
    assert run.wait() == 0, run.err
    assert not run.left_processes() and not run.left_in_shared_memory()
    notes = run.results["notes"].get("pong", [])
    assert len(notes) == times and all("took over" in note for note in notes)
    assert run.err.count("it is started again") == times
    return notes


def check_killed(mortal, undisturbed, moment, scheme):
    """A run of a scheme with a death at a moment has the bits of one without."""
    fails_in, fails_at = MOMENTS[moment]
    pong = f'fails_in = "{fails_in}"\nfails_at = {fails_at}'
    arguments = ("--set", f'scheme="{scheme}"', *SNAPSHOTS)
    run = mortal(pong, ping="pause = 2e-3", arguments=arguments)
    (note,) = check_restarted(run)
    assert DIED in note
    assert same(run.folder, undisturbed(scheme))
    return int(re.search(r"repeated (\d+) window", note)[1])


@pytest.mark.parametrize("moment", SERIAL)
def test_a_component_that_is_killed_takes_up_its_work_with_the_same_bits(
    mortal, undisturbed, moment
):
    windows = check_killed(mortal, undisturbed, moment, "serial")
    # Windows since the snapshots after windows 40 and 80, or since a state that was saved later.
    limits = {"later window": 20, "between": 40, "snapshot": 40, "end": 20}
    assert windows <= limits.get(moment, 0)


@pytest.mark.parametrize(("moment", "scheme"), OTHER_SCHEMES)
def test_windows_that_are_stepped_at_once_or_repeated_are_taken_up(
    mortal, undisturbed, moment, scheme
):
    check_killed(mortal, undisturbed, moment, scheme)


def test_a_process_that_ends_itself_or_stands_still_is_replaced(mortal, undisturbed):
    for cause in ("os._exit", "SIGSTOP"):
        pong = f'fails_in = "step"\nfails_at = 21\nfails_by = "{cause}"'
        run = mortal(pong, arguments=SNAPSHOTS)
        check_restarted(run)
        assert ("stopped responding" in run.err) == (cause == "SIGSTOP")
        assert same(run.folder, undisturbed("serial"))


def test_what_a_process_has_started_ends_with_it(mortal):
    run = mortal('child = true\nfails_in = "step"\nfails_at = 21', ping="pause = 0.02")
    log = run.folder / "log" / "pong.log"
    run.wait_until(lambda: log.is_file() and log.read_text().count("step 50") == 1)
    commands = [Path(f"/proc/{pid}/cmdline").read_bytes() for pid in run.processes()]
    assert sum(OUTLIVES.encode() in command for command in commands) == 1
    check_restarted(run)


@pytest.mark.slow
def test_a_replay_that_takes_longer_than_the_patience_is_no_fault(mortal):
    pong = 'pause = 0.2\nfails_in = "later"\nfails_at = 14'
    run = mortal(pong, arguments=("--set", "patience=1.5", "--set", "end=0.03"))
    (note,) = check_restarted(run)
    seconds = float(re.search(r"after ([\d.]+) s", note)[1])
    assert seconds > 2.8 and "s in window" not in run.err


def test_what_came_before_the_last_state_is_not_repeated(mortal):
    run = mortal('pause = 0.05\nfails_in = "step"\nfails_at = 161', arguments=("--set", "end=0.09"))
    (note,) = check_restarted(run)
    assert int(re.search(r"repeated (\d+) window", note)[1]) < 75
    assert not list(run.folder.glob("snapshot-*.h5"))


def test_a_component_that_dies_too_often_ends_the_run(mortal):
    run = mortal('fails_in = "step"\nfails_at = 21\ntimes = 3', restarts=2)
    assert run.wait() == 3 and not run.left_processes()
    fault = run.results["fault"]
    assert fault["component"] == "pong" and fault["window"] == 10
    assert DIED in fault["cause"] and "it was started again 2 time(s) before" in fault["cause"]
    assert run.err.count("it is started again (restart") == 2


@pytest.mark.parametrize("cause", ["exception", "NaN"])
def test_what_would_occur_again_is_no_death(mortal, cause):
    run = mortal(f'fails_in = "step"\nfails_at = 21\nfails_by = "{cause}"')
    assert run.wait() == 3
    message = {"exception": "asked to raise", "NaN": "must be finite"}[cause]
    assert message in run.results["fault"]["cause"] and "started again" not in run.err


def test_a_process_that_does_not_repeat_the_same_bits_ends_the_run(mortal):
    run = mortal('fails_in = "step"\nfails_at = 21\ndiffers = true')
    assert run.wait() == 3 and not run.left_processes()
    cause = run.results["fault"]["cause"]
    assert DIED in cause and "order advance: out.number has other bits" in cause


def test_without_restarts_a_death_ends_the_run_as_ever(mortal):
    run = mortal('fails_in = "step"\nfails_at = 21', restarts=0)
    assert run.wait() == 3
    assert run.results["fault"]["cause"].endswith(DIED) and "started again" not in run.err


@pytest.mark.mpi
@pytest.mark.parametrize(
    ("fails_in", "fails_at"), [pytest.param("build", 0, marks=pytest.mark.full), ("after", 121)]
)
def test_a_component_of_which_a_rank_dies_takes_up_its_work(tmp_path, fails_in, fails_at):
    keys = f'moment = "{tmp_path / "deaths"}"\nfails_by = "SIGKILL"\ntimes = 1\n'
    keys += f"fails_at = {fails_at}\nfails_in = "
    runs = []
    for name, moment in (("killed", fails_in), ("alone", "never")):
        folder = tmp_path / name
        kind = "toy_rank_faults:FaultyChain"
        scene = write(folder, "zenoh", 2, keys=f'{keys}"{moment}"', kind=kind, patience=30.0)
        runs.append(Started(scene, "--set", f"restarts={int(name == 'killed')}"))
        assert runs[-1].wait() == 0, runs[-1].err
        assert not runs[-1].left_processes() and not runs[-1].left_in_shared_memory()
    (note,) = runs[0].results["notes"]["chain"]
    assert "rank 1 on " in note and DIED in note
    assert same(*(run.folder for run in runs))


@pytest.mark.parametrize("transport", ["memory", "mpi"])
def test_restarts_are_refused_where_no_process_ends_alone(tmp_path, capsys, transport):
    scene = write_scene(tmp_path, transport)
    with pytest.raises(SystemExit) as exit_info:
        main(["check", str(scene), "--set", "restarts=1"])
    assert exit_info.value.code == 2
    message = capsys.readouterr().err
    assert f"scene.restarts must be 0 over the transport {transport}" in message
