"""``quintet calibrate SCENE --over KEY=LOW:HIGH --to EXPECTATION``: the number that fits best.

An optimiser (optuna's tree-structured Parzen estimator, Bergstra et al., NIPS 24 (2011)) proposes
values from a seed and from the misfits of all runs before, two at a time whatever is run at once.
The runs are done as those of a sweep. Nothing else is stored: called again, the optimiser proposes
the same values, whose runs are found complete, and goes on from there.
"""

import argparse
import json
from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from quintet.coupler.files.disk import write_whole
from quintet.coupler.files.json_file import JsonFile
from quintet.coupler.files.run_files import REPORT
from quintet.coupler.measures.evaluation import reference_value
from quintet.coupler.measures.expectation import Expectation
from quintet.coupler.measures.misfit_profile import misfit_interval
from quintet.coupler.report.calibration_report import draw, sentences
from quintet.coupler.report.show import console
from quintet.coupler.report.sweep_report import write_csv
from quintet.coupler.run import results
from quintet.coupler.run.folder import share
from quintet.coupler.scene.key_ranges import KeyRange, read_ranges
from quintet.coupler.scene.overrides import command_line
from quintet.coupler.scene.read import load
from quintet.coupler.scene.sweep_axes import Axis
from quintet.coupler.study.ensemble import scatter_of
from quintet.coupler.study.run_jobs import Row, RunSeries, check_numbers, run_jobs
from quintet.coupler.study.sweep_plan import SceneRequest, plan
from quintet.coupler.study.sweep_progress import SweepProgress
from quintet.coupler.study.sweep_run import JOURNAL, Job
from quintet.interfaces.errors import SceneError
from quintet.interfaces.libraries import require
from quintet.interfaces.params import unknown

if TYPE_CHECKING:
    from optuna import Study, Trial

NAME, TABLE, PICTURE = "calibrate.json", "calibrate.csv", "calibrate.png"
BATCH = 2  # values that are proposed at once
EVEN = 5  # values, evenly between the ends, before the optimiser proposes any
DIGITS = 6  # of a value
MOST = 1000  # runs


@dataclass(slots=True)
class Calibration(RunSeries):
    """A calibration: its runs, the best value of each key, and an interval of it.

    Attributes
    ----------
    scene : str
        Name of the scene.
    folder : Path
        With a folder for each run.
    command : str
        Repeats it.
    to : str
        Name of the expectation.
    unit : str
        Of the misfit, the distance between the expectation's value and its reference.
    rise, rise_from : float, str
        How far the misfit rises from its least to the ends of the interval, and why so far.
    rows : list of dict
        One for each run, as those of a sweep, with its `misfit`; None where it has none.
    keys : dict
        By the keys that are varied: `best`, `low`, `high`, `open_below` and `open_above`; empty
        where no run has a value.
    misfit : float or None
        The least.
    """

    scene: str
    folder: Path
    command: str
    to: str
    unit: str
    rise: float
    rise_from: str
    rows: list[Row] = field(default_factory=list)
    keys: dict[str, Row] = field(default_factory=dict)
    misfit: float | None = None

    def summary(self) -> Row:
        """All of it, for programs."""
        names = ("scene", "to", "unit", "rise", "rise_from", "misfit", "keys", "rows")
        content = {name: getattr(self, name) for name in names}
        return {**content, "failed": [row["run"] for row in self.failed]} | {
            "machine": results.machine(),
            "command": self.command,
        }


def run_calibrate(options: argparse.Namespace) -> int:
    """Calibrate from the command line; return the exit status."""
    asked = (options.scene, options.preset, options.settings, options.swap, options.transport)
    wanted = JsonFile(options.json, ("scene", "keys"))
    ranges = read_ranges(options.over)
    numbers = (options.runs, options.seed, options.jobs, options.retry)
    fitted = calibrate(asked, ranges, options.to, options.out, *numbers, options.ensemble)
    wanted.write(fitted.summary())
    screen = console()
    for sentence in sentences(fitted.summary()):
        screen.print(sentence, markup=False)
    for row in fitted.failed:
        screen.print(f"{row['status']}: {row['label']}: {row['cause']}", markup=False)
    for name in (TABLE, PICTURE):
        if (fitted.folder / name).is_file():
            screen.print(f"left {fitted.folder / name}", soft_wrap=True)
    return fitted.status


def calibrate(
    asked: SceneRequest,
    ranges: Sequence[KeyRange],
    to: str,
    out: Path | None,
    runs: int,
    seed: int,
    jobs: int,
    retry: int,
    ensemble: Path | None = None,
    executor: Executor | None = None,
) -> Calibration:
    """Seek the values with the least misfit; write table, results and picture.

    Parameters
    ----------
    asked : tuple
        Scene, preset, settings, swaps and transport, as on the command line.
    ranges : sequence of KeyRange
    to : str
        Expectation whose distance from its reference is made least.
    out : path or None
        Folder of the calibration, new, empty, or of a former calibration.
    runs, seed : int
    jobs, retry : int
        Runs at once, and how often a run is repeated that was killed from outside.
    ensemble : path or None
        Folder of an ensemble; the interval is where the misfit rises by its standard deviation. If
        not given, by the tolerance of the expectation.
    executor : Executor or None
        Does the runs in the place of threads of this process.
    """
    require("optuna", "calibrate")
    check_numbers("calibrate", jobs, retry)
    if not 1 <= runs <= MOST:
        raise SceneError(f"calibrate: --runs must be 1 to {MOST}; found {runs}. Correct it.")
    scene = load(*asked)
    expected = {expectation.name: expectation for expectation in scene.expect}
    if to not in expected:
        raise SceneError(unknown(f"--to {to}", to, expected))
    expectation = expected[to]
    rise, rise_from = expectation.within, "its tolerance"
    if ensemble is not None:
        rise, rise_from = scatter_of(ensemble, to), f"the standard deviation of {ensemble}"
    folder_name, _ = plan("calibrate", asked, _corners(ranges), jobs, retry)
    folder = share("calibrate", folder_name, (NAME, TABLE, PICTURE, JOURNAL, REPORT), out)
    words = [word for span in ranges for word in ("--over", span.text)]
    words += ["--to", to, "--runs", str(runs), "--seed", str(seed)]
    words += ["--ensemble", str(ensemble)] if ensemble else []
    command = command_line("calibrate", *asked, words=words)
    fitted = Calibration(folder_name, folder, command, to, expectation.unit, rise, rise_from)
    print(f"{folder_name}: {runs} runs, {jobs} at once, in {folder}", flush=True)
    reference = reference_value(expectation, scene.folder)
    series = _Series(fitted, asked, ranges, expectation, reference, jobs, retry, executor)
    progress = SweepProgress(runs)
    try:
        _optimise(series, runs, seed, progress)
    finally:
        progress.close()
    _conclude(fitted, ranges)
    return fitted


def _corners(ranges: Sequence[KeyRange]) -> list[Row]:
    """Settings at both ends of all ranges: a scene that refuses them is not begun."""
    ends = ([span.low for span in ranges], [span.high for span in ranges])
    return [_settings(ranges, values) for values in ends]


def _settings(ranges: Sequence[KeyRange], values: Sequence[float]) -> Row:
    pairs = zip(ranges, values, strict=True)
    return {key: number for span, value in pairs for key, number in span.settings(value).items()}


@dataclass(slots=True)
class _Series:
    """What all batches of a calibration have in common."""

    fitted: Calibration
    asked: SceneRequest
    ranges: Sequence[KeyRange]
    expectation: Expectation
    reference: float
    jobs: int
    retry: int
    executor: Executor | None

    def run(self, batch: Sequence[Row], progress: SweepProgress) -> list[Row]:
        """Do the runs of a batch of settings; return a row of each, with its misfit."""
        unlike = [
            settings for number, settings in enumerate(batch) if settings not in batch[:number]
        ]
        _, planned = plan("calibrate", self.asked, unlike, self.jobs, self.retry)
        tasks: list[Job] = [replace(job, place=self.fitted.folder) for job in planned]
        rows = run_jobs(tasks, self.jobs, self.executor, progress=progress)
        for row in rows:
            value = row["values"].get(self.expectation.name)
            known = row["status"] == "done" and value is not None
            row["misfit"] = abs(value - self.reference) if known else None
        return [rows[unlike.index(settings)] for settings in batch]


def _optimise(series: _Series, runs: int, seed: int, progress: SweepProgress) -> None:
    """Propose values batch by batch, and run them, until there are enough or one is interrupted."""
    study = _study(series.ranges, runs, seed)
    rows = series.fitted.rows
    axes = [Axis(key, ()) for span in series.ranges for key in span.keys]
    while len(rows) < runs:
        trials = [study.ask() for _ in range(min(BATCH, runs - len(rows)))]
        batch = [_settings(series.ranges, _values(series.ranges, trial)) for trial in trials]
        done = series.run(batch, progress)
        rows += done
        write_csv(axes, rows, series.fitted.folder / TABLE)
        if series.fitted.status == results.INTERRUPTED:
            return
        _tell(study, trials, done)


def _study(ranges: Sequence[KeyRange], runs: int, seed: int) -> "Study":
    """Make an optimiser whose first values are even, and whose others depend on the seed."""
    # Users without the extra never come here.
    import optuna

    optuna.logging.set_verbosity(optuna.logging.ERROR)
    even = min(EVEN, runs)
    sampler = optuna.samplers.TPESampler(seed=seed, n_startup_trials=even)
    study = optuna.create_study(sampler=sampler, direction="minimize")
    for share_of in np.linspace(0.0, 1.0, even) if even > 1 else [0.5]:
        values = {span.name: span.low + float(share_of) * (span.high - span.low) for span in ranges}
        if len(ranges) == 1:  # of several keys even values would be those of a diagonal
            study.enqueue_trial(values)
    return study


def _values(ranges: Sequence[KeyRange], trial: "Trial") -> list[float]:
    proposed = [trial.suggest_float(span.name, span.low, span.high) for span in ranges]
    return [_rounded(value, span) for value, span in zip(proposed, ranges, strict=True)]


def _rounded(value: float, span: KeyRange) -> float:
    """Round a value, but not to beyond the ends of its range."""
    return min(max(float(f"{value:.{DIGITS}g}"), span.low), span.high)


def _tell(study: "Study", trials: Sequence["Trial"], rows: Sequence[Row]) -> None:
    """Tell the optimiser all misfits of a batch, in the order in which it proposed them."""
    # Users without the extra never come here.
    from optuna.trial import TrialState

    for trial, row in zip(trials, rows, strict=True):
        if row["misfit"] is None:
            study.tell(trial, state=TrialState.FAIL)
        else:
            study.tell(trial, row["misfit"])


def _conclude(fitted: Calibration, ranges: Sequence[KeyRange]) -> None:
    """Find the best values and their intervals; write what is left."""
    known = [row for row in fitted.rows if row.get("misfit") is not None]
    if known:
        misfits = [row["misfit"] for row in known]
        best = known[int(np.argmin(misfits))]
        fitted.misfit = best["misfit"]
        level = fitted.misfit + fitted.rise
        for span in ranges:
            values = [row["settings"][span.keys[0]] for row in known]
            interval = misfit_interval(values, misfits, level, interpolate=len(ranges) == 1)
            fitted.keys[span.name] = {"best": best["settings"][span.keys[0]], **asdict(interval)}
    summary: dict[str, Any] = fitted.summary()
    write_whole(fitted.folder / NAME, json.dumps(summary, indent=2))
    draw(summary, fitted.folder / PICTURE)
