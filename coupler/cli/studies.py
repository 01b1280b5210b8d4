"""Commands that run a scene many times: studies, limits, scans, sweeps, ensembles, controls."""

import argparse
from pathlib import Path

from quintet.coupler.cli.options import (
    FOR_PROGRAMS,
    TRANSPORTS,
    Command,
    add_report,
    add_scene,
    seed,
)

KEEP = "reuse completed runs in DIR, of the same scene on the same machine"
ERROR = "recommend the cheapest setting of this relative error, as in 0.05"
RUN = "with --error: run the recommended setting if it is an extrapolated one"
BESIDE = (
    "also run another program on the same problem, in turns with the refinements; its inputs are "
    "in peers/NAME beside the scene; may be repeated"
)
STUDY_ALL = "the quick refinements of all scenes that come with quintet; goes on where it was ended"
MINUTES = "with --all: start no run that would end later (default: 60)"
STABILITY_ALL = "the limits of all scenes that come with quintet; goes on where it was ended"
SCENES_AT_ONCE = "with --all: scenes at once (default: 2)"
LIMITS_README = "with --all: put the table between <!-- stability --> and its end mark in this file"
README = "with --all: put the table between <!-- study --> and <!-- studied --> of this file"
ALL = "scan all scenes that come with quintet and have scans"
OVER = "a key and its values, as in components.plate.thickness=0.002,0.004; may be repeated"
JOBS = "runs at once (default: 2)"
JOBS_OF_SWEEP = "runs at once (default: 2; in the queue of SLURM: 64)"
ENGINE = "what does the runs: this host, or SLURM, of which each run is a job (default: local)"
SBATCH = "option of sbatch for each run, as in --sbatch=--time=01:00:00; may be repeated"
SNAKEFILE = "run nothing: write a Snakefile whose rules do the same runs"
RETRY = "repeat a run so often whose process was killed from outside (default: 1)"
SWEEP_OUT = "folder of all runs, new or of a former sweep (default: runs/SCENE-sweep)"
ALL_CONTROLS = "the controls of all scenes that come with quintet, cheapest first"
CONTROLS_TRANSPORT = "how messages travel (default: memory)"
CONTROLS_OUT = "folder of all runs, new or of former controls (default: runs/controls)"
CONTROLS_JSON = "write the results as JSON to this file; other scenes that it has are kept"
SHOW = "print the table of a file that --json left, as Markdown; run nothing"
ENSEMBLE_OUT = "folder of all runs, new or of a former ensemble (default: runs/SCENE-ensemble)"
SEED = "of the random numbers (default: 0); the same seed gives the same runs"
CALIBRATE_OUT = "folder of all runs, new or of a former calibration (default: runs/SCENE-calibrate)"
RANGE = "a number of the scene and its range; KEY,KEY=LOW:HIGH gives several keys the same number"
TO = "the expectation whose distance from its reference is made least"
TRIALS = "runs of the calibration (default: 20); more of them keep those there are"
SCATTER = "an ensemble: its standard deviation, not the tolerance, makes the interval"
RUNS = "runs of the ensemble (default: 32); more of them keep those there are"
QUICK = "with --all: use the preset quick of scenes that have one"


def add_commands(command: Command) -> None:
    """Add what runs a scene many times."""
    study = command(
        "study", series, "measure error against run time over the refinements of a scene"
    )
    add_scene(study, nargs="?")
    add_report(study, "runs/SCENE-study")
    study.add_argument("--keep", action="store_true", help=KEEP)
    study.add_argument("--error", type=float, metavar="E", help=ERROR)
    study.add_argument("--run", action="store_true", help=RUN)
    study.add_argument("--beside", action="append", default=[], metavar="NAME", help=BESIDE)
    study.add_argument("--all", action="store_true", help=STUDY_ALL)
    study.add_argument("--minutes", type=float, metavar="M", help=MINUTES)
    study.add_argument("--readme", type=Path, metavar="FILE", help=README)
    stability = command("stability", series, "find the stability limits of a scene")
    add_scene(stability, nargs="?")
    add_report(stability, "runs/SCENE-stability")
    stability.add_argument("--all", action="store_true", help=STABILITY_ALL)
    stability.add_argument("--jobs", type=int, metavar="N", help=SCENES_AT_ONCE)
    stability.add_argument("--readme", type=Path, metavar="FILE", help=LIMITS_README)
    scan = command("scan", series, "check whether wrong results of absurd settings are reported")
    add_scene(scan, nargs="?")
    scan.add_argument("--all", action="store_true", help=ALL)
    scan.add_argument("--quick", action="store_true", help=QUICK)
    scan.add_argument("--name", default="", metavar="SCAN", help="one of the scene's scans")
    add_report(scan, "runs/SCENE-scan")
    scan.add_argument("--keep", action="store_true", help=KEEP)
    sweep = command("sweep", series, "run a scene for each combination of the values of some keys")
    add_scene(sweep)
    sweep.add_argument("--over", action="append", default=[], metavar="KEY=VALUE,...", help=OVER)
    _add_jobs(sweep, SWEEP_OUT, None, JOBS_OF_SWEEP)
    sweep.add_argument("--engine", choices=("local", "slurm"), default="local", help=ENGINE)
    sweep.add_argument("--sbatch", action="append", default=[], metavar="OPTION", help=SBATCH)
    sweep.add_argument("--snakefile", type=Path, metavar="FILE", help=SNAKEFILE)
    ensemble = command(
        "ensemble", series, "the distribution of results where a scene's inputs are uncertain"
    )
    add_scene(ensemble)
    ensemble.add_argument("--runs", type=int, default=32, metavar="N", help=RUNS)
    ensemble.add_argument("--seed", type=seed, default=0, metavar="N", help=SEED)
    _add_jobs(ensemble, ENSEMBLE_OUT)
    calibrate = command("calibrate", series, "seek the numbers with which a scene fits best")
    add_scene(calibrate)
    calibrate.add_argument(
        "--over", action="append", default=[], metavar="KEY=LOW:HIGH", help=RANGE
    )
    calibrate.add_argument("--to", required=True, metavar="EXPECTATION", help=TO)
    calibrate.add_argument("--runs", type=int, default=20, metavar="N", help=TRIALS)
    calibrate.add_argument("--seed", type=seed, default=0, metavar="N", help=SEED)
    calibrate.add_argument("--ensemble", type=Path, metavar="DIR", help=SCATTER)
    _add_jobs(calibrate, CALIBRATE_OUT)
    controls = command(
        "controls", series, "check whether tolerances reject the wrong settings of a scene"
    )
    controls.add_argument("scene", nargs="?", help="a name from quintet list, or a TOML file")
    controls.add_argument("--all", action="store_true", help=ALL_CONTROLS)
    controls.add_argument("--transport", choices=TRANSPORTS, default="", help=CONTROLS_TRANSPORT)
    controls.add_argument("--json", type=Path, metavar="FILE", help=CONTROLS_JSON)
    controls.add_argument("--show", type=Path, metavar="FILE", help=SHOW)
    controls.add_argument("--out", type=Path, metavar="DIR", help=CONTROLS_OUT)


def _add_jobs(
    command: argparse.ArgumentParser, folder: str, jobs: int | None = 2, at_once: str = JOBS
) -> None:
    """Add how runs are done that are kept in one folder, and where it is."""
    command.add_argument("--jobs", type=int, default=jobs, metavar="N", help=at_once)
    command.add_argument("--retry", type=int, default=1, metavar="N", help=RETRY)
    command.add_argument("--json", type=Path, metavar="FILE", help=FOR_PROGRAMS)
    command.add_argument("--out", type=Path, metavar="DIR", help=folder)


def series(options: argparse.Namespace) -> int:
    """Run a scene many times, as the command says."""
    # Start-up: only these commands need them.
    from quintet.coupler.study.calibrate import run_calibrate
    from quintet.coupler.study.controls import run_controls
    from quintet.coupler.study.ensemble import run_ensemble
    from quintet.coupler.study.scan import run_scan
    from quintet.coupler.study.stability import run_stability
    from quintet.coupler.study.studies import run_all
    from quintet.coupler.study.study import run_study
    from quintet.coupler.study.sweep import run_sweep

    if options.command == "study" and options.all and options.scene is None:
        return run_all(options)
    runs = {
        "study": run_study,
        "stability": run_stability,
        "scan": run_scan,
        "sweep": run_sweep,
        "ensemble": run_ensemble,
        "calibrate": run_calibrate,
        "controls": run_controls,
    }
    return runs[options.command](options)
