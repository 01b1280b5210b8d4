"""Runs that are disturbed on purpose, by kills from outside or by ``--chaos``; ``python`` it.

``disturbed_runs.py chaos SCENE --seeds 200`` runs a scene with the seeds 0 to 199 of ``--chaos``.
``disturbed_runs.py kills SCENE --seeds 25`` kills a component, a rank, the coupler or all processes
at once at random moments, and resumes the run where it ended with that. Both compare the bits with
those of an undisturbed run, look for what is left behind, and print a table.
"""

import argparse
import re
import subprocess
import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

TOYS = Path(__file__).parents[1] / "toy_scenes"
sys.path.insert(0, str(TOYS))
from kills import WHO, Killed  # noqa: E402
from started import Started, same  # noqa: E402

LONGEST = 3600.0  # s of an undisturbed run
HANG = 120.0  # s beyond the time of an undisturbed run, and beyond ten times that time
AS_UNDISTURBED, NAMED = "bits of the undisturbed run", "status 3 with a named cause"
HANGS, WRONG = "HANG", "WRONG"


@dataclass
class Verdict:
    """How a disturbed run ended."""

    end: str
    detail: str = ""
    resumed: str = ""  # how a run that had failed went on
    chaos: dict = field(default_factory=dict)  # what results.json says of ``--chaos``
    left: list[str] = field(default_factory=list)
    lost: list[float] = field(default_factory=list)  # s of work, of each kill
    seconds: float = 0.0

    @property
    def right(self):
        """Whether it is what the rule allows."""
        allowed = self.end in (AS_UNDISTURBED, NAMED) and self.resumed in ("", AS_UNDISTURBED)
        return allowed and not self.left


def left_by(run):
    """Processes and shared memory that a run has left."""
    left = [f"process {pid}" for pid in run.left_processes(5.0)]
    return left + [f"/dev/shm/{name}" for name in run.left_in_shared_memory()]


def compared(run, alone, status):
    """Whether a run that came to its end has the status and the bits of one alone."""
    try:
        equal = same(run.folder, alone.folder)
    except (AssertionError, OSError, KeyError) as error:
        return WRONG, f"it differs: {error!r:.200}"
    if not equal or run.process.returncode != status:
        return WRONG, f"status {run.process.returncode}, {'same' if equal else 'OTHER'} bits"
    return AS_UNDISTURBED, ""


def kind_of(cause):
    """A cause without what differs from run to run."""
    cause = re.split(r" The run is disturbed| \(\d", cause)[0]
    cause = re.sub(r"^\S+/(?=[\w.-]+: it cannot be written)", "", cause)
    return re.sub(r"-?\d+(\.\d+)?(e-?\d+)?", "N", cause)[:110]


def judge(run, alone, status, seconds):
    """Wait for the end of a run, and judge it."""
    began = time.monotonic()
    try:
        ended = run.wait(10.0 * seconds + HANG)
    except subprocess.TimeoutExpired:
        return Verdict(HANGS, "after " + " ".join(run.err.split())[-200:])
    left = left_by(run)
    results = run.results if (run.folder / "results.json").is_file() else {}
    if ended == 3:
        cause = results.get("fault", {}).get("cause", "")
        told = cause and "Traceback" not in run.err
        verdict = Verdict(NAMED if told else WRONG, kind_of(cause) or "no cause", left=left)
        verdict.resumed = resumed(run, alone, status) if "resume" in results else ""
    else:
        verdict = Verdict(*compared(run, alone, status), left=left)
    verdict.chaos = results.get("chaos", {})
    verdict.seconds = time.monotonic() - began
    return verdict


def resumed(run, alone, status):
    """How a run that failed goes on."""
    again = Started(run.scene, out=run.folder, resumes=True)
    again.wait(LONGEST)
    return compared(again, alone, status)[0]


def of_chaos(options, scene, place, seed, alone, status, seconds, arguments):
    """A run with a seed of ``--chaos``."""
    run = Started(scene, "--chaos", str(seed), *arguments, out=place)
    verdict = judge(run, alone, status, seconds)
    if not verdict.right:
        print(run.err[-4000:])
    return verdict


def of_kills(options, scene, place, seed, alone, status, seconds, arguments):
    """A run among kills from outside."""
    settings = list(arguments)
    if options.transport == "zenoh":
        settings += ["--set", f"restarts={2 * options.kills}"]
    killed = Killed(scene, place, settings, seed, options.kills, seconds, options.who)
    verdict = judge(killed.run, alone, status, seconds)
    verdict.lost = killed.lost()
    print("   ", "; ".join(killed.told), flush=True)
    if not verdict.right:
        print(killed.run.err[-4000:])
    return verdict


def undisturbed(options, scene, folder, arguments):
    """Run the scene alone, twice: the first time, kernels may be compiled; tell its seconds."""
    for name in ("compiles", "alone"):
        began = time.monotonic()
        alone = Started(scene, *arguments, out=folder / name)
        status = alone.wait(LONGEST)
        assert status in (0, 1), alone.err
    return alone, status, time.monotonic() - began


def series(options):
    """Try one scene with many seeds; return the number of runs that broke the rule."""
    arguments = [word for setting in options.set for word in ("--set", setting)]
    arguments += ["--preset", options.preset] if options.preset else []
    arguments += ["--transport", options.transport]
    ways = {"chaos": of_chaos, "kills": of_kills}
    verdicts = []
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        scene = folder / options.scene  # whose folder names the run to `Started`
        Started.command = staticmethod(
            lambda _: [sys.executable, "-m", "quintet.coupler.cli", "run", options.scene]
        )
        alone, status, seconds = undisturbed(options, scene, folder, arguments)
        seconds = options.within or seconds
        print(f"undisturbed: status {status}, {seconds:.1f} s", flush=True)
        for seed in range(options.first, options.first + options.seeds):
            verdict = ways[options.way](
                options, scene, folder / str(seed), seed, alone, status, seconds, arguments
            )
            verdicts.append(verdict)
            more = [verdict.detail, verdict.resumed and f"resumed: {verdict.resumed}"]
            more += [f"work lost {max(verdict.lost):.1f} s"] if verdict.lost else []
            more += [f"LEFT {verdict.left}"] if verdict.left else []
            said = "; ".join(filter(None, [verdict.end, *more]))
            print(f"seed {seed}: {said}; {verdict.seconds:.1f} s", flush=True)
    print(table(verdicts))
    return sum(not verdict.right for verdict in verdicts)


def table(verdicts):
    """How all runs ended."""
    rows = Counter((verdict.end, verdict.detail, verdict.resumed) for verdict in verdicts)
    lines = ["", "| runs | end | cause | resumed |", "|--:|---|---|---|"]
    lines += [f"| {number} | {' | '.join(row)} |" for row, number in sorted(rows.items())]
    left = sum(bool(verdict.left) for verdict in verdicts)
    lines.append(f"\n{len(verdicts)} runs, {left} of them left something behind")
    lost = [seconds for verdict in verdicts for seconds in verdict.lost]
    if lost:
        lines.append(f"{len(lost)} kills, at most {max(lost):.1f} s of work lost with one")
    return "\n".join(lines)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("way", choices=["chaos", "kills"])
    parser.add_argument("scene")
    parser.add_argument("--preset", default="")
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--transport", default="zenoh", choices=["zenoh", "mpi", "memory"])
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--kills", type=int, default=1, help="in each run")
    parser.add_argument("--who", default="any", choices=["any", *WHO])
    parser.add_argument("--within", type=float, help="s, instead of the time of a whole run")
    sys.exit(min(series(parser.parse_args()), 100))
