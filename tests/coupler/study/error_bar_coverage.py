"""How often the true error lies within its error bar, on scenes with exact answers.

    .venv/bin/python tests/coupler/study/error_bar_coverage.py [--json FILE] [--every N] [NAME ...]

Each case runs as a user would run it, with ``--error-bar``. Its recording gives the true errors: of
a window, its end less the exact flow of its beginning; of the value, the state less the exact flow
of the start. `--calibrate` looks at the cases from which the constants of the bars are.
"""

import argparse
import contextlib
import io
import json
import shutil
import tempfile
from itertools import pairwise
from pathlib import Path

import numpy as np
from error_bar_cases import calibration_cases, cases
from scipy.stats import spearmanr

from quintet.coupler.files.recording import Recording
from quintet.coupler.measures.error_bars import Samples, bar_about, error_curve, window_bar
from quintet.coupler.measures.time_series import Curve
from quintet.coupler.run.run_scene import run_scene
from quintet.coupler.scene.read import load

ROOT = Path(__file__).resolve().parents[3]
MODULES = Path(__file__).with_name("exact_pairs.py"), ROOT / "scenarios/two_springs/springs.py"
FIRST = 0.1  # of a run: in it no value is looked at


def run(case, folder, *settings):
    """Run a case with its error bars; return the folder of the run."""
    folder.mkdir(parents=True)
    for module in MODULES:
        shutil.copy(module, folder)
    (folder / "scene.toml").write_text(case.text)
    scene = load(str(folder / "scene.toml"), settings=["error_bar.on=true", *settings])
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        run_scene(scene, folder / "run")
    return folder / "run"


def states(case, recording):
    """Times (rows,) s, and states (rows, d), of a run."""
    columns = []
    for path in case.state:
        name, _, key = path.partition(".")
        column = recording.field(name, key)
        columns.append(column.reshape(len(column), -1)[:, 0])
    return recording.times(case.state[0].partition(".")[0]), np.array(columns).T


def true_errors(case, times, state):
    """Errors of the windows (rows - 1, d), and of the values (rows, d)."""
    dt = times[1] - times[0]
    exact = [state[0]]
    for _ in times[1:]:
        exact.append(case.flow(exact[-1], dt))
    windows = [end - case.flow(start, dt) for start, end in pairwise(state)]
    return np.array(windows), state - np.array(exact)


def energy_residuals(case, recording):
    """Work that the link makes in each window, (rows - 1,) J; None where it carries heat.

    The residual of Sadjina et al., Eng. Comput. 33 (2017) 607: the side that is pushed takes the
    impulse of the window before along the way of this one.
    """
    giver, taker = (path.partition(".")[0] for path in (case.state[-1], case.state[0]))
    if "foot_load.force" not in recording.fields(giver):
        return None
    impulses = recording.field(giver, "foot_load.force")[:, 0, 0]  # N s
    way = np.diff(recording.field(taker, "motion.position")[:, 0, 0])  # m
    dt = np.diff(recording.times(taker))  # s
    impulse_change = 0.0 if "iterated" in case.text else np.diff(impulses)
    return impulse_change * way / dt + np.zeros(len(way))


def rank_correlation(first, second):
    """Spearman's correlation of the magnitudes; nan where one is constant."""
    if np.ptp(np.abs(first)) == 0.0 or np.ptp(np.abs(second)) == 0.0:
        return float("nan")
    return float(spearmanr(np.abs(first), np.abs(second)).statistic)


def coverage(case, folder):
    """One row of the table for each watched quantity of a case that was run."""
    bars = json.loads((folder / "results.json").read_text())["error_bar"]
    with Recording(folder / "recording.h5") as recording:
        times, state = states(case, recording)
        residuals = energy_residuals(case, recording)
    local, total = true_errors(case, times, state)
    for row in bars["watched"]:
        column = case.state.index(row["name"])
        samples = Samples(bars["windows"], bars["weights"], row["rests"], row["drifts"])
        curve = error_curve(samples, bars["every"], Curve(times, state[:, column]))
        bar = [bar_about(*pair) for pair in zip(curve.expected, curve.deviation, strict=True)]
        inside = np.abs(total[:, column]) <= bar
        sampled = np.array(bars["windows"]) - 1
        unsampled = np.setdiff1d(np.arange(1, len(local)), sampled)
        later_samples = sampled[sampled > 0]
        estimates, truths = (
            np.array(row["errors"])[sampled > 0],
            np.abs(local[later_samples, column]),
        )
        by_energy = np.zeros(len(later_samples)) if residuals is None else residuals[later_samples]
        yield {
            "case": case.name,
            "quantity": row["name"],
            "windows": len(unsampled),
            "samples": len(later_samples),
            "order": row["order"],
            "window": float(np.mean(np.abs(local[unsampled, column]) <= window_bar(estimates))),
            "estimate": float(np.median(estimates[truths > 0.0] / truths[truths > 0.0])),
            "rank_pieces": rank_correlation(estimates, truths),
            "rank_energy": rank_correlation(by_energy, truths),
            "values": float(np.mean(inside[int(FIRST * len(inside)) :])),
            "end": bool(inside[-1]),
            "end_error": float(abs(total[-1, column])),
            "end_bar": bar[-1],
            "told": (row["window"], row["value"]),
        }


def table(rows):
    """The rows as a table of Markdown, and a summary of all of them."""
    yield (
        "| case | quantity | windows | sampled | window | estimate / error | rank: pieces | "
        "rank: energy | values | end: error | end: bar |"
    )
    yield "|---|---|" + 9 * "--:|"
    for row in rows:
        yield (
            f"| {row['case']} | `{row['quantity']}` | {row['windows']} | {row['samples']} "
            f"| {100.0 * row['window']:.1f} % | {row['estimate']:.4f} "
            f"| {row['rank_pieces']:.2f} | {row['rank_energy']:.2f} "
            f"| {100.0 * row['values']:.0f} % "
            f"| {row['end_error']:.2g} | {row['end_bar']:.2g} |"
        )
    count = sum(row["windows"] for row in rows)
    windows = sum(row["windows"] * row["window"] for row in rows) / count
    values = sum(row["values"] for row in rows) / len(rows)
    cases_seen = len({row["case"] for row in rows})
    yield (
        f"{100.0 * windows:.1f} % of {count} window errors in {cases_seen} scenes, "
        f"{100.0 * values:.1f} % of the values; at the end {sum(row['end'] for row in rows)} of "
        f"{len(rows)}"
    )


def main():
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("names", nargs="*", help="cases (default: all)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the rows to this file")
    parser.add_argument(
        "--runs", type=Path, metavar="DIR", help="keep runs here, and use them again"
    )
    parser.add_argument("--every", type=int, help="windows of a stratum (default: of quintet)")
    parser.add_argument("--calibrate", action="store_true", help="the cases of the constants")
    options = parser.parse_args()
    settings = [f"error_bar.every={options.every}"] if options.every else []
    selected_cases = calibration_cases() if options.calibrate else cases()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for case in selected_cases:
            if not options.names or case.name in options.names:
                place = (options.runs or Path(folder)) / case.name
                is_complete = (place / "run/results.json").is_file()
                rows += coverage(
                    case, place / "run" if is_complete else run(case, place, *settings)
                )
    print(*table(rows), sep="\n")
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()
