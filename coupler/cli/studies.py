"""Commands that run a scene many times: study, stability, scan."""

import argparse

from quintet.coupler.cli.options import Command, add_report, add_scene

KEEP = "reuse completed runs in DIR, of the same scene on the same machine"
ALL = "scan all scenes that come with quintet and have scans"
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


def series(options: argparse.Namespace) -> int:
    """Run a scene many times: a study, stability limits, or scans."""
    # Start-up: only these commands need them.
    from quintet.coupler.study.scan import run_scan
    from quintet.coupler.study.stability import run_stability
    from quintet.coupler.study.study import run_study

    runs = {"study": run_study, "stability": run_stability, "scan": run_scan}
    return runs[options.command](options)
