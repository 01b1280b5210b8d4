"""``quintet conform``: one line for each law, and the status by which a script knows."""

import argparse
import sys
from pathlib import Path
from typing import Any

from quintet.coupler.conform.cases import of_file, of_kind, of_scene, trials
from quintet.coupler.conform.check import Finding, try_all
from quintet.coupler.conform.laws import name_of
from quintet.coupler.conform.trial import Trial
from quintet.coupler.files.json_file import JsonFile
from quintet.coupler.scene.kinds import named_kind
from quintet.interfaces.errors import SceneError
from quintet.interfaces.manifest import ConformCase, Manifest

SLOW = 1.0  # s; what takes longer says so


def run_conform(options: argparse.Namespace) -> int:
    """Try the laws on a kind; 0 if all that apply are kept, else 1."""
    wanted = JsonFile(options.json, ("kind", "conforms"))
    manifest, cases, folder = choose(options)
    reports: dict[str, list[Finding]] = {}
    with trials(manifest, cases, folder) as ready:
        for trial in ready:
            print(f"{manifest.kind}, {trial.case.name}", flush=True)
            reports[trial.case.name] = report(trial)
    all_found = [finding for findings in reports.values() for finding in findings]
    counts = {status: sum(finding.status == status for finding in all_found) for status in STATUSES}
    print(f"{manifest.kind} {summary(counts)}")
    if counts["failed"] > 1:
        print("Begin with the first that failed: others may follow from it.")
    if options.json:
        entries = [
            {"case": k, "laws": [_entry(finding) for finding in v]} for k, v in reports.items()
        ]
        result = {"kind": manifest.kind, "conforms": not counts["failed"], "cases": entries}
        wanted.write(result)
    return 1 if counts["failed"] else 0


STATUSES = ("passed", "failed", "does not apply")


def choose(options: argparse.Namespace) -> tuple[Manifest, tuple[ConformCase, ...], Path | None]:
    """What is tried: a kind's own cases, parameters of a file, or a component of a scene."""
    if bool(options.scene) != bool(options.component) or (options.scene and options.params):
        raise SceneError("conform needs --scene with --component, or --params, or neither.")
    if not options.scene:
        if (options.preset or options.settings) or not options.kind:
            raise SceneError("conform needs a KIND; --preset and --set belong to --scene.")
        manifest = named_kind(options.kind, "conform")
        if options.params:
            return manifest, (of_file(options.params),), options.params.resolve().parent
        return manifest, of_kind(manifest, options.case), None
    manifest, case, folder = of_scene(
        options.scene, options.component, options.preset, options.settings
    )
    if options.kind and options.kind != manifest.kind:
        raise SceneError(
            f"conform: {options.component} of {options.scene} is of kind {manifest.kind}; found "
            f"{options.kind}. Leave the kind out."
        )
    return manifest, (case,), folder


def report(trial: Trial) -> list[Finding]:
    """Try all laws and print a line for each; in a terminal, the one that is being tried too."""
    findings, live = [], sys.stdout.isatty()
    for law, finding in try_all(trial):
        if finding is None:
            if live:
                print(f"  {'...':<16}{name_of(law)}", end="\r", flush=True)
            continue
        print(line(finding), flush=True)
        findings.append(finding)
    return findings


def line(finding: Finding) -> str:
    """One finding."""
    duration = f" ({finding.seconds:.1f} s)" if finding.seconds >= SLOW else ""
    reason = f": {finding.said}" if finding.said else ""
    return f"  {finding.status:<16}{finding.law}{reason}{duration}"


def summary(counts: dict[str, int]) -> str:
    """How many laws were kept, broken, and did not apply."""
    verdict = "conforms" if not counts["failed"] else "does not conform"
    passed, failed, others = counts.values()
    return f"{verdict}; {passed} passed, {failed} failed, {others} do not apply"


def _entry(finding: Finding) -> dict[str, Any]:
    return {
        "law": finding.law,
        "status": finding.status,
        "said": finding.said,
        "seconds": round(finding.seconds, 3),
    }
