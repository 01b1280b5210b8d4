"""Processor time that error bars add to a run, and the share of its wall time in trial windows.

    .venv/bin/python tests/coupler/study/error_bar_cost.py SCENE END [PATH=VALUE ...]

The scene runs to END [s] with and without error bars by turns, and once for a window alone, whose
time, that of starting, is subtracted from both. Where other programs use the same cores, processor
times of equal runs differ by more than the bars cost; shares of one run's own time do not.
"""

import json
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

ROUNDS = 3
QUINTET = Path(sys.executable).with_name("quintet")


def processor_time(scene, settings, out):
    """Processor time of a run and of its processes [s]."""
    arguments = [argument for setting in settings for argument in ("--set", setting)]
    command = [QUINTET, "run", scene, "--transport", "memory", *arguments, "--out", out]
    start_times = os.times()
    subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
    end_times = os.times()
    child_times = (end_times.children_user, end_times.children_system)
    return sum(child_times) - start_times.children_user - start_times.children_system


def checks_share(out):
    """Share of the wall time of a run that went into trial windows."""
    timing = json.loads((out / "results.json").read_text())["timing"]
    return timing["checks"] / timing["wall"]


def main():
    """Print the medians."""
    scene, end, *settings = sys.argv[1:]
    settings += ["output.pictures=[]"]
    kinds = {"start": 1e-3, "without": 1.0, "with": 1.0}
    times, shares = {kind: [] for kind in kinds}, {kind: [] for kind in kinds}
    with tempfile.TemporaryDirectory() as folder:
        for number in range(ROUNDS):
            for kind, share in kinds.items():
                switch = str(kind == "with").lower()
                run_settings = [*settings, f"end={share * float(end)}", f"error_bar.on={switch}"]
                out = Path(folder) / f"{kind}{number}"
                times[kind].append(processor_time(scene, run_settings, out))
                shares[kind].append(checks_share(out))
    start, without, with_bars = (statistics.median(times[kind]) for kind in kinds)
    print(f"start {start:.2f} s, without {without:.2f} s, with error bars {with_bars:.2f} s")
    print(f"they cost {100.0 * (with_bars - without) / (without - start):.1f} % of the run")
    share = statistics.median(shares["with"]) - statistics.median(shares["without"])
    print(f"their trial windows take {100.0 * share:.1f} % of the wall time")


if __name__ == "__main__":
    main()
