"""Runs of scenes whose components are killed at random moments; ``python`` it with a scene.

``python tests/coupler/faults/random_kills.py SCENE [--preset quick] --seeds 10`` prints what each
kill cost, and whether the run ended with the bits of an undisturbed one.
"""

import argparse
import os
import random
import re
import signal
import sys
import tempfile
import time
from pathlib import Path

TOYS = Path(__file__).parents[1] / "toy_scenes"
sys.path.insert(0, str(TOYS))
from started import Started, same  # noqa: E402

SERVES = b"quintet.interfaces.serving.process"


def components(run):
    """Processes of the components of a run, ranks included."""
    pids = []
    for pid in run.processes():
        try:
            words = Path(f"/proc/{pid}/cmdline").read_bytes().split(b"\0")
        except OSError:
            continue
        if SERVES in words and words[0].endswith((b"python", b"python3")):
            pids.append(pid)
    return pids


def kill_at_random(run, seed, kills, seconds):
    """Kill components at random moments of the next seconds; return the moments."""
    choice, began, done = random.Random(seed), time.monotonic(), []
    for moment in sorted(choice.uniform(0.0, seconds) for _ in range(kills)):
        while time.monotonic() - began < moment and run.process.poll() is None:
            time.sleep(0.005)
        if run.process.poll() is None and (alive := components(run)):
            pid = choice.choice(sorted(alive))
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                continue
            done.append(round(moment, 2))
    return done


def costs(run):
    """Seconds after which another process had taken over, for each restart."""
    return [float(cost) for cost in re.findall(r"took over after ([\d.]+) s", run.err)]


def disturbed(scene, folder, seed, kills, seconds, *arguments):
    """Run a scene to its end while components are killed."""
    settings = ("--set", f"restarts={2 * kills}", "--transport", "zenoh", *arguments)
    run = Started(scene, *settings, out=folder)
    moments = kill_at_random(run, seed, kills, seconds)
    return run, moments


def report(options):
    """Try one scene with many seeds."""
    arguments = [word for setting in options.set for word in ("--set", setting)]
    arguments += ["--preset", options.preset] if options.preset else []
    wrong = 0
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        scene = folder / options.scene  # whose folder names the run to `Started`
        Started.command = staticmethod(
            lambda _: [sys.executable, "-m", "quintet.coupler.cli", "run", options.scene]
        )
        for name in ("compiles", "alone"):
            began = time.monotonic()
            alone = Started(scene, "--transport", "zenoh", *arguments, out=folder / name)
            status = alone.wait(3600.0)
            seconds = options.within or time.monotonic() - began
        print(f"undisturbed: status {status}; kills within {seconds:.1f} s", flush=True)
        for seed in range(options.first, options.first + options.seeds):
            place = folder / str(seed)
            began = time.monotonic()
            run, moments = disturbed(scene, place, seed, options.kills, seconds, *arguments)
            ended = run.wait(3600.0)
            right = ended == status and same(place, alone.folder)
            wrong += not right
            print(
                f"seed {seed}: killed at {moments} s; status {ended}, "
                f"{'same bits' if right else 'OTHER BITS'}, {time.monotonic() - began:.1f} s; "
                f"taken over after {costs(run)} s; left {run.left_processes()}",
                flush=True,
            )
            if not right:
                print(run.err[-3000:])
    return wrong


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("scene")
    parser.add_argument("--preset", default="")
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--kills", type=int, default=2)
    parser.add_argument("--within", type=float, help="s, instead of the time of a whole run")
    sys.exit(report(parser.parse_args()))
