"""Mutated scenes are checked in short time and little memory; mistakes are told in sentences."""

import json
import resource
import signal
import subprocess
import sys

import psutil
import pytest
from scene_mutants import mutants

from quintet.coupler.cli import main
from quintet.coupler.scene.read import load
from quintet.interfaces.errors import SceneError

LONGEST = 30  # s, of one check
COMPILED = 900  # s, of one run with empty caches, on a machine that does other things too
MOST = 200e6  # bytes, that one check may add
SEED = 20261122


class Hang(BaseException):
    """A check that does not end."""


def checked(mutant, capsys):
    """Status of a check, and what it said; no more than its time and its memory."""

    def end(*_):
        raise Hang(f"{mutant.name}: {mutant.path} {mutant.arguments}")

    before, peak = psutil.Process().memory_info().rss, peak_memory()
    former = signal.signal(signal.SIGALRM, end)
    signal.alarm(LONGEST)
    try:
        main(["check", str(mutant.path), *mutant.arguments])
    except SystemExit as ended:
        status = ended.code
    except Exception as error:
        raise AssertionError(f"{mutant.name}: {mutant.path} {mutant.arguments}") from error
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, former)
    now = peak_memory()
    assert now == peak or now - before < MOST, f"{mutant.name}: {(now - before) / 1e6:.0f} MB"
    return status, capsys.readouterr().err


def peak_memory():
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def check_all(capsys, folder, count, seed):
    """Check so many mutants; return those that may be run."""
    sound = []
    for mutant in mutants(folder, count, seed):
        status, said = checked(mutant, capsys)
        lines = said.splitlines()
        assert status in (0, 2), mutant
        assert bool(lines) == (status == 2), (mutant, said)
        assert all(line.startswith("quintet: ") and len(line) < 5000 for line in lines), said
        assert "Traceback" not in said
        if status == 0:
            sound.append(mutant)
    return sound


def start(mutant, out):
    """Run a mutant in a process of its own, over three windows at most; return status and words."""
    scene = load(str(mutant.path), *overrides(mutant))
    window = scene.file.window
    steps = [one.planned.dt for one in scene.components.values() if one.planned]
    short = 3.0 * (window if window != "auto" else min(steps, default=scene.file.end / 300.0))
    command = [sys.executable, "-m", "quintet.coupler.cli", "run", str(mutant.path)]
    command += [*mutant.arguments, "--transport", "memory", "--out", str(out)]
    changes = [f"end={min(short, scene.file.end)!r}", "output.pictures=[]"]
    changes += ["study=[]", "stability=[]", "scan=[]"]  # whose windows may be longer
    command += [word for change in changes for word in ("--set", change)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=COMPILED)
    return done.returncode, done.stderr


def overrides(mutant):
    """Preset, settings and swaps of a mutant's arguments, as `load` takes them."""
    found = {"--preset": "", "--set": [], "--swap": []}
    if mutant.arguments:
        option, value = mutant.arguments
        found[option] = value if option == "--preset" else [value]
    return found["--preset"], found["--set"], found["--swap"]


def small(mutant):
    """Whether a few windows of a mutant take little time."""
    try:
        scene = load(str(mutant.path), *overrides(mutant))
    except SceneError:
        return False
    plans = [one.planned for one in scene.components.values() if one.planned]
    window = scene.file.window if scene.file.window != "auto" else 0.0
    work = sum(one.items * max(1.0, window / one.dt) for one in plans)
    return work < 2e5


def test_a_few_mutated_scenes_are_refused_in_sentences(capsys, tmp_path):
    sound = check_all(capsys, tmp_path, 66, SEED)
    springs = [mutant for mutant in sound if mutant.name.startswith("two_springs")]
    for number, mutant in enumerate(springs[:2]):
        status, said = start(mutant, tmp_path / f"out{number}")
        assert status in (0, 1, 2, 3) and "Traceback" not in said, said


@pytest.mark.full
def test_10000_mutated_scenes_are_refused_in_sentences(capsys, tmp_path):
    sound = check_all(capsys, tmp_path, 10_000, SEED + 1)
    started = [mutant for mutant in sound if small(mutant)][::64]
    assert len(started) >= 20
    found = {}
    for number, mutant in enumerate(started):
        status, said = start(mutant, tmp_path / f"out{number}")
        assert status in (0, 1, 2, 3) and "Traceback" not in said, (mutant, said)
        found[mutant.name] = status
    with capsys.disabled():
        print(json.dumps({"sound": len(sound), "started": found}, indent=2))
