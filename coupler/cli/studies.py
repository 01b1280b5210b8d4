"""Commands that run a scene many times: study, stability, scan, sweep."""

import argparse
from pathlib import Path

from quintet.coupler.cli.options import FOR_PROGRAMS, Command, add_report, add_scene

KEEP = "reuse completed runs in DIR, of the same scene on the same machine"
ALL = "scan all scenes that come with quintet and have scans"
OVER = "a key and its values, as in components.plate.thickness=0.002,0.004; may be repeated"
JOBS = "runs at once (default: 2)"
RETRY = "repeat a run so often whose process was killed from outside (default: 1)"
SWEEP_OUT = "folder of all runs, new or of a former sweep (default: runs/SCENE-sweep)"
QUICK = "with --all: use the preset quick of scenes that have one"


def add_commands(command: Command) -> None:
    """Add what runs a scene many times."""
    study = command(
        "study", series, "measure error against run time over the refinements of a scene"
    )
    add_scene(study)
    add_report(study, "runs/SCENE-study")
    study.add_argument("--keep", action="store_true", help=KEEP)
    stability = command("stability", series, "find the stability limits of a scene")
    add_scene(stability)
    add_report(stability, "runs/SCENE-stability")
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
    sweep.add_argument("--jobs", type=int, default=2, metavar="N", help=JOBS)
    sweep.add_argument("--retry", type=int, default=1, metavar="N", help=RETRY)
    sweep.add_argument("--json", type=Path, metavar="FILE", help=FOR_PROGRAMS)
    sweep.add_argument("--out", type=Path, metavar="DIR", help=SWEEP_OUT)


def series(options: argparse.Namespace) -> int:
    """Run a scene many times: a study, stability limits, scans, or a sweep."""
    # Start-up: only these commands need them.
    from quintet.coupler.study.scan import run_scan
    from quintet.coupler.study.stability import run_stability
    from quintet.coupler.study.study import run_study
    from quintet.coupler.study.sweep import run_sweep

    runs = {"study": run_study, "stability": run_stability, "scan": run_scan, "sweep": run_sweep}
    return runs[options.command](options)
