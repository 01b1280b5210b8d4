"""Mutated scenes are checked in short time and little memory; each mistake is a sentence."""

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


def check_mutant(mutant, capsys):
    """Status and errors of a check, which must keep to its time and its memory."""

    def end(*_):
        raise Hang(f"{mutant.name}: {mutant.path} {mutant.arguments}")

    memory, peak = psutil.Process().memory_info().rss, peak_memory()
    handler = signal.signal(signal.SIGALRM, end)
    signal.alarm(LONGEST)
    try:
        main(["check", str(mutant.path), *mutant.arguments])
    except SystemExit as exit_call:
        status = exit_call.code
    except Exception as error:
        raise AssertionError(f"{mutant.name}: {mutant.path} {mutant.arguments}") from error
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, handler)
    new_peak = peak_memory()
    assert new_peak == peak or new_peak - memory < MOST, (
        f"{mutant.name}: {(new_peak - memory) / 1e6:.0f} MB"
    )
    return status, capsys.readouterr().err


def peak_memory():
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def check_all(capsys, folder, count, seed):
    """Check a number of mutants; return the mutants that may run."""
    sound = []
    for mutant in mutants(folder, count, seed):
        status, message = check_mutant(mutant, capsys)
        lines = message.splitlines()
        assert status in (0, 2), mutant
        assert bool(lines) == (status == 2), (mutant, message)
        assert all(line.startswith("quintet: ") and len(line) < 5000 for line in lines), message
        assert "Traceback" not in message
        if status == 0:
            sound.append(mutant)
    return sound


def start(mutant, out):
    """Run a mutant in its own process, over three windows at most; return status and errors."""
    scene = load(str(mutant.path), *overrides(mutant))
    window = scene.file.window
    steps = [component.planned.dt for component in scene.components.values() if component.planned]
    duration = 3.0 * (window if window != "auto" else min(steps, default=scene.file.end / 300.0))
    command = [sys.executable, "-m", "quintet.coupler.cli", "run", str(mutant.path)]
    command += [*mutant.arguments, "--transport", "memory", "--out", str(out)]
    changes = [f"end={min(duration, scene.file.end)!r}", "output.pictures=[]"]
    changes += ["study=[]", "stability=[]", "scan=[]"]  # whose windows may be longer
    command += [word for change in changes for word in ("--set", change)]
    result = subprocess.run(command, capture_output=True, text=True, timeout=COMPILED)
    return result.returncode, result.stderr


def overrides(mutant):
    """Preset, settings and swaps of a mutant's arguments, as `load` takes them."""
    options = {"--preset": "", "--set": [], "--swap": []}
    if mutant.arguments:
        option, value = mutant.arguments
        options[option] = value if option == "--preset" else [value]
    return options["--preset"], options["--set"], options["--swap"]


def small(mutant):
    """Whether a few windows of a mutant take little time."""
    try:
        scene = load(str(mutant.path), *overrides(mutant))
    except SceneError:
        return False
    components = scene.components.values()
    plans = [component.planned for component in components if component.planned]
    window = scene.file.window if scene.file.window != "auto" else 0.0
    work = sum(plan.items * max(1.0, window / plan.dt) for plan in plans)
    return work < 2e5


def test_a_few_mutated_scenes_are_refused_in_sentences(capsys, tmp_path):
    sound = check_all(capsys, tmp_path, 66, SEED)
    springs = [mutant for mutant in sound if mutant.name.startswith("two_springs")]
    for number, mutant in enumerate(springs[:2]):
        status, message = start(mutant, tmp_path / f"out{number}")
        assert status in (0, 1, 2, 3) and "Traceback" not in message, message


@pytest.mark.full
def test_10000_mutated_scenes_are_refused_in_sentences(capsys, tmp_path):
    sound = check_all(capsys, tmp_path, 10_000, SEED + 1)
    runnable = [mutant for mutant in sound if small(mutant)][::64]
    assert len(runnable) >= 20
    statuses = {}
    for number, mutant in enumerate(runnable):
        status, message = start(mutant, tmp_path / f"out{number}")
        assert status in (0, 1, 2, 3) and "Traceback" not in message, (mutant, message)
        statuses[mutant.name] = status
    with capsys.disabled():
        print(json.dumps({"sound": len(sound), "started": statuses}, indent=2))
