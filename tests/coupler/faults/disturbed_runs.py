"""Runs that are disturbed on purpose, by kills from outside or by ``--chaos``; a command.

``disturbed_runs.py chaos SCENE --seeds 200`` runs a scene with the seeds 0 to 199 of ``--chaos``.
``disturbed_runs.py kills SCENE --seeds 25`` kills a component, a rank, the coupler or all processes
at once at random moments, and resumes the run if a kill ended it. Both compare the bits with
those of an undisturbed run, look for leftover processes and files, and print a table.
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
    chaos: dict = field(default_factory=dict)  # the entry of ``--chaos`` in results.json
    left: list[str] = field(default_factory=list)
    lost: list[float] = field(default_factory=list)  # s of work, of each kill
    seconds: float = 0.0

    @property
    def right(self):
        """Whether the rule allows this end."""
        allowed = self.end in (AS_UNDISTURBED, NAMED) and self.resumed in ("", AS_UNDISTURBED)
        return allowed and not self.left


def left_by(run):
    """Processes and shared memory that a run has left."""
    leftovers = [f"process {pid}" for pid in run.left_processes(5.0)]
    return leftovers + [f"/dev/shm/{name}" for name in run.left_in_shared_memory()]


def compared(run, reference, status):
    """Whether a run that came to its end has the status and the bits of one alone."""
    try:
        equal = same(run.folder, reference.folder)
    except (AssertionError, OSError, KeyError) as error:
        return WRONG, f"it differs: {error!r:.200}"
    if not equal or run.process.returncode != status:
        return WRONG, f"status {run.process.returncode}, {'same' if equal else 'OTHER'} bits"
    return AS_UNDISTURBED, ""


def kind_of(cause):
    """A cause without the details that differ from run to run."""
    cause = re.split(r" The run is disturbed| \(\d", cause)[0]
    cause = re.sub(r"^\S+/(?=[\w.-]+: it cannot be written)", "", cause)
    return re.sub(r"-?\d+(\.\d+)?(e-?\d+)?", "N", cause)[:110]


def judge(run, reference, status, seconds):
    """Wait for the end of a run, and judge it."""
    start = time.monotonic()
    try:
        exit_status = run.wait(10.0 * seconds + HANG)
    except subprocess.TimeoutExpired:
        return Verdict(HANGS, "after " + " ".join(run.err.split())[-200:])
    leftovers = left_by(run)
    results = run.results if (run.folder / "results.json").is_file() else {}
    if exit_status == 3:
        cause = results.get("fault", {}).get("cause", "")
        explained = cause and "Traceback" not in run.err
        verdict = Verdict(
            NAMED if explained else WRONG, kind_of(cause) or "no cause", left=leftovers
        )
        verdict.resumed = resumed(run, reference, status) if "resume" in results else ""
    else:
        verdict = Verdict(*compared(run, reference, status), left=leftovers)
    verdict.chaos = results.get("chaos", {})
    verdict.seconds = time.monotonic() - start
    return verdict


def resumed(run, reference, status):
    """How a run that failed goes on."""
    resumed_run = Started(run.scene, out=run.folder, resumes=True)
    resumed_run.wait(LONGEST)
    return compared(resumed_run, reference, status)[0]


def of_chaos(options, scene, place, seed, reference, status, seconds, arguments):
    """A run with a seed of ``--chaos``."""
    run = Started(scene, "--chaos", str(seed), *arguments, out=place)
    verdict = judge(run, reference, status, seconds)
    if not verdict.right:
        print(run.err[-4000:])
    return verdict


def of_kills(options, scene, place, seed, reference, status, seconds, arguments):
    """A run among kills from outside."""
    settings = list(arguments)
    if options.transport == "zenoh":
        settings += ["--set", f"restarts={2 * options.kills}"]
    killed = Killed(scene, place, settings, seed, options.kills, seconds, options.who)
    verdict = judge(killed.run, reference, status, seconds)
    verdict.lost = killed.lost()
    print("   ", "; ".join(killed.told), flush=True)
    if not verdict.right:
        print(killed.run.err[-4000:])
    return verdict


def undisturbed(options, scene, folder, arguments):
    """Run the scene undisturbed, twice (the first compiles); return run, status and seconds."""
    for name in ("compiles", "alone"):
        start = time.monotonic()
        reference = Started(scene, *arguments, out=folder / name)
        status = reference.wait(LONGEST)
        assert status in (0, 1), reference.err
    return reference, status, time.monotonic() - start


def series(options):
    """Try one scene with many seeds; return the number of runs that broke the rule."""
    arguments = [argument for setting in options.set for argument in ("--set", setting)]
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
        reference, status, seconds = undisturbed(options, scene, folder, arguments)
        seconds = options.within or seconds
        print(f"undisturbed: status {status}, {seconds:.1f} s", flush=True)
        for seed in range(options.first, options.first + options.seeds):
            verdict = ways[options.way](
                options, scene, folder / str(seed), seed, reference, status, seconds, arguments
            )
            verdicts.append(verdict)
            details = [verdict.detail, verdict.resumed and f"resumed: {verdict.resumed}"]
            details += [f"work lost {max(verdict.lost):.1f} s"] if verdict.lost else []
            details += [f"LEFT {verdict.left}"] if verdict.left else []
            summary = "; ".join(filter(None, [verdict.end, *details]))
            print(f"seed {seed}: {summary}; {verdict.seconds:.1f} s", flush=True)
    print(table(verdicts))
    return sum(not verdict.right for verdict in verdicts)


def table(verdicts):
    """How all runs ended."""
    rows = Counter((verdict.end, verdict.detail, verdict.resumed) for verdict in verdicts)
    lines = ["", "| runs | end | cause | resumed |", "|--:|---|---|---|"]
    lines += [f"| {number} | {' | '.join(row)} |" for row, number in sorted(rows.items())]
    unclean_runs = sum(bool(verdict.left) for verdict in verdicts)
    lines.append(f"\n{len(verdicts)} runs, {unclean_runs} of them left something behind")
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
