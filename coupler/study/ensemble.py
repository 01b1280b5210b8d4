"""``quintet ensemble SCENE --runs 32``: the distribution of results where inputs are uncertain.

Every run draws the scene's uncertain numbers (``[ensemble]``) anew; its results are one sample. The
runs are done as those of a sweep: called again, only those that are missing are run.
"""

import argparse
import json
import math
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from quintet.coupler.files.disk import write_whole
from quintet.coupler.files.json_file import JsonFile
from quintet.coupler.files.recording import Recording
from quintet.coupler.files.run_files import REPORT
from quintet.coupler.measures.ensemble_inputs import origins
from quintet.coupler.measures.ensemble_statistics import QUANTILES, Band, band, statistics
from quintet.coupler.measures.evaluation import curve, reference_curve, reference_value
from quintet.coupler.measures.expectation import DISTANCES, Expectation
from quintet.coupler.measures.time_series import Curve, points_between
from quintet.coupler.report.ensemble_report import draw, origins_table, table, write_statistics
from quintet.coupler.report.show import console
from quintet.coupler.report.sweep_report import write_csv
from quintet.coupler.run import results
from quintet.coupler.run.folder import share
from quintet.coupler.scene.ensemble_table import Perturbation, draw_settings
from quintet.coupler.scene.overrides import command_line
from quintet.coupler.scene.quantity_texts import units_of_keys
from quintet.coupler.scene.read import load_variants
from quintet.coupler.scene.scene import Scene
from quintet.coupler.scene.sweep_axes import Axis
from quintet.coupler.study.run_jobs import Row, RunSeries, check_numbers, run_jobs
from quintet.coupler.study.sweep_plan import SceneRequest, plan
from quintet.coupler.study.sweep_run import JOURNAL
from quintet.interfaces.errors import SceneError

NAME, TABLE, RUNS, PICTURE = "ensemble.json", "ensemble.csv", "runs.csv", "ensemble.png"
MOST = 10_000  # runs


@dataclass(slots=True)
class Ensemble(RunSeries):
    """An ensemble: its runs, and the statistics of what they gave.

    Attributes
    ----------
    scene : str
        Name of the scene.
    folder : Path
        With a folder for each run.
    command : str
        Repeats it.
    seed : int
    perturbations : dict
        By name: keys and distribution.
    rows : list of dict
        One for each run, as those of a sweep: `run`, `settings`, `status`, `values`, `cause`, ...
    expectations : list of dict
        One for each expectation: `name`, `unit`, `count`, `mean`, `deviation`, `interval`,
        `quantiles`, `reference`, `reference_deviation`, `within`, and `inside`: the share of the
        reference between the quantiles of 5 % and 95 %, of a number 0 or 1, of a curve that of its
        points; and `origins`: what its spread comes from, None of too few runs.
    """

    scene: str
    folder: Path
    command: str
    seed: int
    perturbations: dict[str, Row]
    rows: list[Row] = field(default_factory=list)
    expectations: list[Row] = field(default_factory=list)

    def summary(self) -> Row:
        """All of it, for programs."""
        return {
            "scene": self.scene,
            "seed": self.seed,
            "runs": len(self.rows),
            "failed": [row["run"] for row in self.failed],
            "perturbations": self.perturbations,
            "expectations": self.expectations,
            "rows": self.rows,
            "machine": results.machine(),
            "command": self.command,
        }


def run_ensemble(options: argparse.Namespace) -> int:
    """Run an ensemble from the command line; return the exit status."""
    asked = (options.scene, options.preset, options.settings, options.swap, options.transport)
    wanted = JsonFile(options.json, ("scene", "expectations"))
    numbers = (options.runs, options.seed, options.jobs, options.retry)
    sampled = ensemble(asked, options.out, *numbers)
    wanted.write(sampled.summary())
    screen = console()
    screen.print(table(sampled.expectations))
    if any(row["origins"] for row in sampled.expectations):
        screen.print(origins_table(sampled.expectations))
    for row in sampled.failed:
        screen.print(f"{row['status']}: run {row['run']}: {row['cause']}", markup=False)
    done = sum(row["status"] == "done" for row in sampled.rows)
    screen.print(f"{done} of {len(sampled.rows)} runs are done, {len(sampled.failed)} failed")
    for name in (TABLE, RUNS, PICTURE):
        if (sampled.folder / name).is_file():
            screen.print(f"left {sampled.folder / name}", soft_wrap=True)
    return sampled.status


def ensemble(
    asked: SceneRequest,
    out: Path | None,
    runs: int,
    seed: int,
    jobs: int,
    retry: int,
    executor: Executor | None = None,
) -> Ensemble:
    """Do the runs of an ensemble that are not complete; write statistics, table and picture.

    Parameters
    ----------
    asked : tuple
        Scene, preset, settings, swaps and transport, as on the command line.
    out : path or None
        Folder of the ensemble, new, empty, or of a former ensemble.
    runs, seed : int
    jobs : int
        Runs at once, on this host.
    retry : int
        How often a run is repeated that was killed from outside.
    executor : Executor or None
        Does the runs in the place of threads of this process.
    """
    check_numbers("ensemble", jobs, retry)
    if not 1 <= runs <= MOST:
        raise SceneError(f"ensemble: --runs must be 1 to {MOST}; found {runs}. Correct it.")
    scene, variants = load_variants(*asked)
    if not variants.ensemble:
        raise SceneError(
            f"{scene.path.name}: there is no [ensemble]. Add a table [ensemble.NAME] with keys and "
            "a distribution for everything that is uncertain."
        )
    products = draw_settings(variants.ensemble, seed, runs)
    name, planned = plan("ensemble", asked, products, jobs, retry)
    folder = share("ensemble", name, (NAME, TABLE, RUNS, PICTURE, JOURNAL, REPORT), out)
    words = ("--runs", str(runs), "--seed", str(seed))
    command = command_line("ensemble", *asked, words=words)
    sampled = Ensemble(name, folder, command, seed, _distributions(variants.ensemble))
    axes = [Axis(key, ()) for key in products[0]]
    print(f"{name}: {runs} runs, {jobs} at once, in {folder}", flush=True)
    tasks = [replace(job, place=folder) for job in planned]

    def write(rows: Sequence[Row]) -> None:
        write_csv(axes, rows, folder / RUNS)

    sampled.rows = run_jobs(tasks, jobs, executor, write)
    write(sampled.rows)
    _conclude(sampled, scene)
    return sampled


def _conclude(sampled: Ensemble, scene: Scene) -> None:
    """Compare the runs that are done with all references; write what is left."""
    done = [row for row in sampled.rows if row["status"] == "done"]
    folders = [sampled.folder / row["run"] for row in done]
    curves = _curves([e for e in scene.expect if e.csv is not None], folders)
    bands = {name: band(computed) for name, computed in curves.items()}
    keys = {name: table["keys"][0] for name, table in sampled.perturbations.items()}
    units = units_of_keys(scene, keys.values())
    sampled.expectations = [
        _judged(expectation, done, bands.get(expectation.name), scene.folder)
        | {"origins": _origins(expectation, done, keys, units, scene.folder)}
        for expectation in scene.expect
    ]
    write_statistics(sampled.expectations, sampled.folder / TABLE)
    write_whole(sampled.folder / NAME, json.dumps(sampled.summary(), indent=2))
    title = f"{scene.headline}\n{len(done)} of {len(sampled.rows)} runs, seed {sampled.seed}"
    references = {
        e.name: reference for e in scene.expect if (reference := reference_curve(e, scene.folder))
    }
    values = [row["values"] for row in done]
    picture = sampled.folder / PICTURE
    draw(sampled.expectations, values, curves, bands, references, picture, title)


def _curves(expectations: Sequence[Expectation], folders: Sequence[Path]) -> dict[str, list[Curve]]:
    """Curves of all runs, by the name of the expectation that compares them with another one."""
    curves: dict[str, list[Curve]] = {expectation.name: [] for expectation in expectations}
    for folder in folders if expectations else ():
        with Recording(folder) as recording:
            for expectation in expectations:
                curves[expectation.name].append(curve(expectation, recording))
    return curves


def _judged(
    expectation: Expectation, done: Sequence[Row], computed: Band | None, folder: Path
) -> Row:
    """Statistics of one expectation, and whether its reference lies inside."""
    values = [row["values"].get(expectation.name) for row in done]
    known = [value for value in values if value is not None]
    sample, reference = statistics(known), reference_value(expectation, folder)
    inside: float | None = None
    target = reference_curve(expectation, folder)
    if target is not None:
        if expectation.measure != "at":
            end = math.inf if expectation.end is None else expectation.end
            target = points_between(target, expectation.begin, end)
        inside = computed.share_inside(target) if computed else None
    elif sample is not None:
        inside = sample.inside(reference)
    row = asdict(sample) if sample else {"count": 0, "mean": None, "deviation": None}
    row |= (
        {"quantiles": dict(zip(map(str, QUANTILES), sample.quantiles, strict=True))}
        if sample
        else {}
    )
    return {
        "name": expectation.name,
        "unit": expectation.unit,
        "measure": expectation.measure,
        "quantity": expectation.quantity,
        **row,
        "without_value": len(values) - len(known),
        "reference": reference,
        "reference_deviation": expectation.deviation,
        "reference_kind": expectation.reference_kind,
        "within": expectation.within,
        "inside": inside,
        "source": expectation.source,
    }


def _origins(
    expectation: Expectation,
    done: Sequence[Row],
    keys: Mapping[str, str],
    units: Mapping[str, str],
    folder: Path,
) -> Row | None:
    """What the spread of one expectation comes from; None of too few runs."""
    known = [row for row in done if row["values"].get(expectation.name) is not None]
    inputs = {name: [row["settings"][key] for row in known] for name, key in keys.items()}
    is_distance = expectation.measure in DISTANCES
    reference = None if is_distance else reference_value(expectation, folder)
    explained = origins(inputs, [row["values"][expectation.name] for row in known], reference)
    if explained is None:
        return None
    row = asdict(explained)
    for effect in row["effects"]:
        effect["unit"] = units.get(keys[effect["name"]], "1")
    return row


def _distributions(perturbations: Sequence[Perturbation]) -> dict[str, Row]:
    """What is drawn, by name."""
    return {
        p.name: {k: v for k, v in asdict(p.table).items() if v is not None} for p in perturbations
    }


def scatter_of(path: Path, expectation: str) -> float:
    """Read the standard deviation of an expectation from the results of an ensemble."""
    file = path / NAME if path.is_dir() else path
    try:
        content: Mapping[str, Any] = json.loads(file.read_text(encoding="utf-8"))
        known = {row["name"]: row["deviation"] for row in content["expectations"]}
        counts = {row["name"]: row["count"] for row in content["expectations"]}
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise SceneError(
            f"--ensemble {path}: it must be the folder of an ensemble, with its {NAME}; it is not "
            "readable as one. Run quintet ensemble first."
        ) from error
    if known.get(expectation) is None:
        raise SceneError(
            f"--ensemble {path}: it must have two values of {expectation} or more; it has "
            f"{counts.get(expectation, 0)}. Name another ensemble, or run more."
        )
    return float(known[expectation])
