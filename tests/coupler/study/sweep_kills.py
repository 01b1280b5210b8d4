"""A sweep whose processes are killed at random; its arguments are the numbers of values of 4 keys.

``python tests/coupler/study/sweep_kills.py 6 6 6 6`` makes 1296 runs. Killed are processes of runs,
the processes beside them, and now and then the sweep itself, which is then started again with the
same command. A run that is started again although it was complete counts as repeated; one whose
start was killed does not. Both are counted from the journal of the sweep.
"""

import argparse
import json
import math
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "toy_scenes"))
from spring_scene import write
from started import MARK, same

KEYS = ("step", "mass", "stiffness", "damping")
FIRST = (1 / 128, 1.0, 50.0, 0.1)
FAILED = 3  # exit status of a sweep
OF_SWEEP = 0.1  # share of the kills that end the sweep itself


def over_options(counts, numbers=None):
    """Values of each key, as options; or one of each, by number."""
    words = []
    for place, (key, first, count) in enumerate(zip(KEYS, FIRST, counts, strict=True)):
        values = [f"{first * (1.0 + 0.1 * k):.6g}" for k in range(count)]
        selected = values if numbers is None else [values[numbers[place]]]
        words += ["--over", f"components.spring.{key}={','.join(selected)}"]
    return words


def line(scene, out, *words):
    """Return the command, as a user types it."""
    python = [sys.executable, "-m", "quintet.coupler.cli", "sweep", str(scene), "--out", str(out)]
    return [*python, "--set", "end=0.25", *words]


class Campaign:
    """A sweep that is started again after each kill."""

    def __init__(self, scene, out, words, mark):
        self.command, self.mark = line(scene, out, *words), f"{MARK}={mark}".encode()
        self.env = {**os.environ, MARK: str(mark)}
        self.out, self.kills, self.sweep = out, Counter(), None
        self.start()

    def start(self):
        with open(self.out.with_suffix(".txt"), "a") as log:
            self.sweep = subprocess.Popen(
                self.command, stdout=log, stderr=log, env=self.env, start_new_session=True
            )

    def goes_on(self):
        """Whether runs remain; starts the sweep again if some runs were killed too often."""
        if self.sweep.poll() == FAILED:
            self.kills["starts after failed runs"] += 1
            self.start()
        return self.sweep.poll() is None

    def others(self):
        """Processes of the runs."""
        pids = []
        for entry in Path("/proc").glob("[0-9]*/environ"):
            try:
                if self.mark in entry.read_bytes().split(b"\0"):
                    pids.append(int(entry.parent.name))
            except OSError:
                continue
        return sorted(set(pids) - {self.sweep.pid})

    def end(self):
        """End the sweep; its runs end with it."""
        os.killpg(self.sweep.pid, signal.SIGKILL)

    def kill_one(self, choice):
        """Kill a process at random; start the sweep again if it was that."""
        if choice.random() < OF_SWEEP:
            os.killpg(self.sweep.pid, signal.SIGKILL)
            self.sweep.wait()
            self.kills["sweep"] += 1
            self.start()
        elif pids := self.others():
            try:
                os.kill(choice.choice(pids), signal.SIGKILL)
                self.kills["run"] += 1
            except ProcessLookupError:
                pass


def counts(out):
    """Starts, ends and repeated runs, from the journal."""
    done, starts, repeated = set(), Counter(), []
    for text in (out / "sweep.log").read_text().splitlines():
        _, run, event = text.split()
        if event in ("started", "resumed"):
            starts[run] += 1
            repeated += [run] if run in done else []
        elif event == "done":
            done.add(run)
    return done, starts, repeated


def report(options):
    """Run the campaign; return whether all is well."""
    choice, total = random.Random(options.seed), math.prod(options.counts)
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        scene, out = write(folder, within=1.0), folder / "all"
        words = [*over_options(options.counts), "--jobs", str(options.jobs), "--retry", "5"]
        start, last_report = time.monotonic(), 0.0
        campaign = Campaign(scene, out, words, folder)
        signal.signal(signal.SIGTERM, lambda *_: (campaign.end(), sys.exit(1)))
        while campaign.goes_on():
            pause = choice.expovariate(1.0 / options.every)
            limit = time.monotonic() + pause
            while time.monotonic() < limit and campaign.sweep.poll() is None:
                time.sleep(0.02)
            if campaign.sweep.poll() is None:
                campaign.kill_one(choice)
            if time.monotonic() - last_report > 60.0 and (out / "sweep.log").is_file():
                last_report = time.monotonic()
                done, starts, repeated = counts(out)
                progress = f"{len(done)} done, {starts.total()} starts, {len(repeated)} repeated"
                print(
                    f"{last_report - start:.0f} s: {progress}, kills {dict(campaign.kills)}",
                    flush=True,
                )
        seconds, status = time.monotonic() - start, campaign.sweep.returncode
        done, starts, repeated = counts(out)
        rows = json.loads((out / "sweep.json").read_text())["rows"]
        states = Counter(row["status"] for row in rows)
        print(f"status {status} after {seconds:.0f} s; {len(rows)} rows: {dict(states)}")
        print(f"kills: {dict(campaign.kills)}")
        extra_starts = starts.total() - total
        print(f"starts: {starts.total()} of {total} runs: {extra_starts} more than runs")
        print(f"repeated though complete: {len(repeated)} ({len(repeated) / total:.2%})")
        most_extra = campaign.kills["run"] + options.jobs * campaign.kills["sweep"]
        sample = [tuple(map(choice.randrange, options.counts)) for _ in range(options.same)]
        equal_runs = 0
        for number, numbers in enumerate(sample):
            reference = folder / f"alone{number}"
            subprocess.run(line(scene, reference, *over_options(options.counts, numbers)),
                           check=True, capture_output=True)  # fmt: skip
            (run,) = (path.parent for path in reference.glob("*/results.json"))
            equal_runs += same(run, out / run.name)
        print(f"same bits as without kills: {equal_runs} of {len(sample)}")
        is_well = status == 0 and states == {"done": total} and equal_runs == len(sample)
        return is_well and len(repeated) <= 0.01 * total and extra_starts <= most_extra


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("counts", type=int, nargs=4, help="numbers of values of the keys")
    parser.add_argument("--every", type=float, default=10.0, help="s between two kills, on average")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--same", type=int, default=8, help="runs that are compared")
    sys.exit(not report(parser.parse_args()))
