"""``quintet study SCENE``: error against run time over the refinements of a scene.

Every refinement is a run in a folder of its own, one after the other, so that they do not share
processors. An interrupted study reports those that ran; ``--keep`` continues from there.
"""

import argparse
import json
from datetime import date
from pathlib import Path
from typing import Any

from quintet.coupler.files.disk import write_whole
from quintet.coupler.files.json_file import JsonFile
from quintet.coupler.files.run_files import REPORT, RESULTS
from quintet.coupler.report import show
from quintet.coupler.report.peer_tables import beside_table, beside_words
from quintet.coupler.report.study_tables import costs_and_errors, orders, shares
from quintet.coupler.report.work_precision import draw
from quintet.coupler.run import results
from quintet.coupler.run.folder import begin_series, discard_former
from quintet.coupler.run.signals import StopRequest
from quintet.coupler.scene.overrides import assignments, command_line
from quintet.coupler.scene.read import load, load_variants
from quintet.coupler.scene.study_table import Refinement
from quintet.coupler.study.child_run import ChildRun
from quintet.coupler.study.conclusion import conclude, shares_at
from quintet.coupler.study.finest import compare_with_finest
from quintet.coupler.study.peers.beside import Beside, refuse_changes
from quintet.coupler.study.peers.peer import KIND, Peer, read_peers
from quintet.coupler.study.row import row_of, worst
from quintet.coupler.study.scene_or_all import require_scene_or_all
from quintet.coupler.study.wanted_error import choose
from quintet.interfaces.errors import SceneError

NAME, PICTURE = "study.json", "study.png"
EXTRAPOLATED = "extrapolated"  # folder of the run of an extrapolated setting
Row = dict[str, Any]


def run_study(options: argparse.Namespace) -> int:
    """Run all refinements, compare them, and recommend a setting."""
    _check_options(options)
    refuse_changes(options)
    asked = (options.scene, options.preset, options.settings, options.swap, options.transport)
    scene, variants = load_variants(*asked)
    wanted = JsonFile(options.json, ("scene", "rows"), kind=dict)
    if not variants.study:
        raise SceneError(f"{scene.path.name}: there is no [[study]]. Add one for every refinement.")
    folders = [refinement.folder for refinement in variants.study]
    if options.run and EXTRAPOLATED in folders:
        raise SceneError(
            f"study: with --run no refinement may have the label {EXTRAPOLATED}. Rename it."
        )
    peers = read_peers(options.beside, scene)
    files = (NAME, PICTURE, REPORT)
    with begin_series(
        "study", scene.file.name, files, options.out, options.force, options.keep
    ) as place:
        place.check_runs([*folders, *([EXTRAPOLATED] if options.run else [])])
        for peer in peers:
            place.check_runs([peer.place(place.path, run).name for run in peer.runs], KIND)
        discard_former(place.path)
        return _run_all(options, scene.file.name, variants.study, place.path, wanted, peers)


def _check_options(options: argparse.Namespace) -> None:
    require_scene_or_all("study", options)
    for option in ("readme", "minutes"):
        if getattr(options, option) is not None:
            raise SceneError(f"--{option} belongs to --all. Remove it, or name no scene.")
    if options.error is not None and not 0.0 < options.error < float("inf"):
        raise SceneError(
            f"--error must be above 0, as 0.05 for 5 %; found {options.error:g}. Correct it."
        )
    if options.run and options.error is None:
        raise SceneError("--run belongs to --error. Give --error 0.05, or remove --run.")


def _run_all(
    options: argparse.Namespace,
    scene: str,
    refinements: list[Refinement],
    folder: Path,
    wanted: JsonFile,
    peers: list[Peer],
) -> int:
    """Run all refinements in a folder; return the exit status."""
    stop, rows = StopRequest(), []
    child = ChildRun.of(options, stop)
    beside = Beside(peers, folder, stop, options.keep)
    with stop.listening():
        for number, refinement in enumerate(refinements):
            load = beside.load()
            place = folder / refinement.folder
            earlier = child.earlier(refinement.settings, place) if options.keep else None
            print(f"{refinement.label}: {'kept' if earlier else 'running'} in {place}", flush=True)
            rows.append(row_of(refinement, earlier or child.run(refinement.settings, place)))
            rows[-1] |= {"date": date_of(place), **load}
            print(f"{refinement.label}: {rows[-1]['status']}, {rows[-1]['wall']:.1f} s", flush=True)
            if rows[-1]["status"] == "interrupted" or stop():
                break
            beside.turn(number, len(refinements))
        folders = {refinement.label: folder / refinement.folder for refinement in refinements}
        summary = summarize(scene, refinements, rows, folders, options.error)
        summary |= beside.summary()
        summary["command"] = _command(options)
        if options.error is not None:
            _check_offer(child, summary["wanted"])
        print_summary(summary)
        if options.run and not stop():
            _run_wanted(child, summary["wanted"], folder)
    write_whole(folder / NAME, json.dumps(summary, indent=2))
    wanted.write(summary)
    if draw(summary, folder / PICTURE):
        print(f"drawn in {folder / PICTURE}")
    return status_of(summary, len(refinements))


def _command(options: argparse.Namespace) -> str:
    """The command that repeats a study."""
    words = [] if options.error is None else ["--error", repr(options.error)]
    words += [word for name in options.beside for word in ("--beside", name)]
    asked = (options.scene, options.preset, options.settings, options.swap, options.transport)
    return command_line("study", *asked, words=words)


def date_of(folder: Path) -> str | None:
    """Day on which the results in a folder were written; None where there are none."""
    path = folder / RESULTS
    return date.fromtimestamp(path.stat().st_mtime).isoformat() if path.is_file() else None


def summarize(
    scene: str,
    refinements: list[Refinement],
    rows: list[Row],
    folders: dict[str, Path],
    error: float | None = None,
) -> Row:
    """Compare rows with references, or with the finest; choose the setting for a wanted error."""
    if not any(row["values"] for row in rows):
        compare_with_finest(rows, folders)
    summary = conclude(scene, rows)
    chosen = summary["recommended"]
    if error is not None:
        summary["wanted"] = choose(error, summary, refinements)
        chosen = summary["wanted"].get("measured")
    summary["shares"] = shares_at(chosen["label"] if chosen else None, rows)
    return summary


def _check_offer(child: ChildRun, wanted: Row) -> None:
    """Withdraw an extrapolated setting that the scene refuses."""
    offer = wanted.get("extrapolated")
    if offer is None:
        return
    settings = [*child.settings, *assignments(offer["settings"])]
    try:
        load(child.scene, child.preset, settings, child.swaps, child.transport)
    except SceneError as error:
        wanted["reason"] = f"the scene refuses the extrapolated {offer['settings']}: {error}"
        del wanted["extrapolated"]


def _run_wanted(child: ChildRun, wanted: Row, folder: Path) -> None:
    """Run an extrapolated setting, and say whether it delivers; what was measured was run."""
    offer = wanted.get("extrapolated")
    if offer is None:
        if "measured" in wanted:
            print(f"{wanted['measured']['label']} was run: nothing is left to run", flush=True)
        return
    place = folder / EXTRAPOLATED
    print(f"{EXTRAPOLATED}: running in {place}", flush=True)
    refinement = Refinement(EXTRAPOLATED, offer["settings"])
    row = row_of(refinement, child.run(offer["settings"], place))
    error = worst(row, wanted["judged"])
    wanted["ran"] = {**row, "delivers": error is not None and error <= wanted["error"]}
    text = "unknown" if error is None else f"{100.0 * error:.3g} %"
    verdict = "delivers" if wanted["ran"]["delivers"] else "does not deliver"
    print(f"{EXTRAPOLATED}: {row['status']}, {row['cpu']:.3g} s of processor time; error {text}: "
          f"it {verdict} {100.0 * wanted['error']:g} %", flush=True)  # fmt: skip


def print_summary(summary: Row) -> None:
    """Print the tables and the recommendation."""
    screen, rows = show.console(), summary["rows"]
    screen.print(costs_and_errors(rows))
    if any(row.get("compared_with") for row in rows):
        screen.print(
            "no expectations: errors are against the finest refinement, relative to the rms "
            "variation of its fields"
        )
    if summary["kinds"]:
        screen.print(orders(summary["kinds"]))
    if summary["shares"]:
        screen.print(shares(summary["shares"]))
    for peer in summary.get("peers", ()):
        screen.print(beside_table(peer, rows))
        for sentence in beside_words(peer, rows):
            screen.print(sentence, markup=False)
    for sentence in recommendation(summary):
        screen.print(sentence, markup=False)


def recommendation(summary: Row) -> list[str]:
    """Say which setting is recommended, and for which error."""
    if "wanted" in summary:
        return _wanted_words(summary["wanted"])
    best = summary["recommended"]
    if best:
        cost = f"{best['cpu']:.3g} s of processor time"
        required = any(row["required"] for row in summary["rows"])
        text = "that meets all required expectations"
        text = text if required else "of all, as no expectation is required"
        return [f"recommended: {best['label']}, the cheapest {text} ({cost})"]
    if all(row["status"] != "done" for row in summary["rows"]):
        return ["recommended: none, as no refinement is done"]
    if not summary["has_expectations"]:
        return ["recommended: none, as there are no expectations; name a wanted --error"]
    return ["recommended: none; no refinement meets all required expectations"]


def _wanted_words(wanted: Row) -> list[str]:
    percent = f"{100.0 * wanted['error']:g} %"
    words = []
    if wanted["left_out"]:
        names = ", ".join(wanted["left_out"])
        words.append(f"left out, for their reference is 0 and they have no relative_to: {names}")
    if best := wanted.get("measured"):
        cost = f"{best['cpu']:.3g} s of processor time"
        error = f"{100.0 * best['relative']:.3g} %"
        return [*words, f"recommended for {percent}: {best['label']}, the cheapest measured that "
                f"delivers it (error {error}, {cost})"]  # fmt: skip
    if offer := wanted.get("extrapolated"):
        values = ", ".join(assignments(offer["settings"]))
        return [*words, f"recommended for {percent}: none that was run. EXTRAPOLATED from "
                f"{offer['from']} ({offer['kind']}), not run: {values}; predicted error "
                f"{100.0 * offer['relative']:.3g} %, predicted {offer['cpu']:.3g} s of processor "
                "time"]  # fmt: skip
    return [*words, f"recommended for {percent}: none; {wanted['reason']}"]


def status_of(summary: Row, refinements: int) -> int:
    """Exit status of the worst run; 1 where no refinement meets what is wanted or expected."""
    peers = summary.get("peers", ())
    states = [row["status"] for row in summary["rows"]]
    states += [row["status"] for peer in peers for row in peer["rows"]]
    left = len(summary["rows"]) < refinements or any(p["runs"] > len(p["rows"]) for p in peers)
    if "interrupted" in states or left:
        return results.INTERRUPTED
    if any(state != "done" for state in states):
        return results.FAILED
    if "wanted" in summary:
        ran = summary["wanted"].get("ran", {})
        delivers = "measured" in summary["wanted"] or ran.get("delivers", False)
        return results.DONE if delivers else results.UNMET
    met = summary["recommended"] or not summary["has_expectations"]
    return results.DONE if met else results.UNMET
