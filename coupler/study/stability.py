"""``quintet stability SCENE``: stability limits found by bisection, against predictions.

For each limit the two ends of its range are run, then the middle of what is left, repeatedly.
Where only expectations fail a scene is degraded, not unstable; that limit is looked for too.
"""

import argparse
import json
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from quintet.coupler.files.disk import write_whole
from quintet.coupler.files.json_file import JsonFile
from quintet.coupler.files.run_files import REPORT
from quintet.coupler.report import marked_place
from quintet.coupler.report.show import console
from quintet.coupler.report.stability_map import PICTURE, draw_maps
from quintet.coupler.report.stability_tables import markdown, print_limits
from quintet.coupler.run import results
from quintet.coupler.run.folder import begin_series, discard_former, share
from quintet.coupler.run.signals import StopRequest
from quintet.coupler.scene.overrides import command_line
from quintet.coupler.scene.quantity_texts import units_of_keys
from quintet.coupler.scene.read import library, load_variants, parse
from quintet.coupler.scene.scene import Scene
from quintet.coupler.scene.stability_table import Limit
from quintet.coupler.scene.varied_tables import folder_name
from quintet.coupler.study.child_run import ChildRun
from quintet.coupler.study.scene_or_all import refuse_with_all, require_scene_or_all
from quintet.coupler.study.stability_search import Search, find_limit, summary
from quintet.interfaces.errors import SceneError

NAME = "stability.json"
SCENES_AT_ONCE = 2
KEYS = ("scene", "limits")  # of the file for programs
Row = dict[str, Any]


@dataclass(frozen=True, slots=True)
class Searches:
    """Searches for the limits of scenes, with the options of the command line."""

    options: argparse.Namespace
    stop: StopRequest
    named: bool = False  # whether lines of progress begin with the scene: several are searched

    def find(self, scene: str, limits: list[Limit], folder: Path) -> list[Row]:
        """Find the limits of a scene in a folder; the last may be incomplete after an interrupt."""
        summaries: list[Row] = []
        for limit in limits if not self.stop() else ():
            for number, other in enumerate(limit.others()):
                place = folder / limit.folder
                place = place if other is None else place / folder_name(f"{other:.6g}")
                keep = not self.options.force
                prefix = f"{folder.name}: " if self.named else ""
                search = Search(limit, other, self._child(scene, limit), place, keep, prefix)
                is_complete = find_limit(search)
                summaries.append(summary(search, limit.predicted(number), is_complete))
                if not is_complete:
                    return summaries
        return summaries

    def _child(self, scene: str, limit: Limit) -> ChildRun:
        options = self.options
        transport = options.transport or limit.table.transport
        asked = (scene, options.preset, options.settings, options.swap, transport)
        return ChildRun(*asked, self.stop, force=True)


def run_stability(options: argparse.Namespace) -> int:
    """Find every limit of the scene, or of all; print them, and write them as JSON."""
    require_scene_or_all("stability", options)
    if options.all:
        return _run_all(options)
    for option in ("readme", "jobs"):
        if getattr(options, option) is not None:
            raise SceneError(f"--{option} is for --all. Add --all, or remove it.")
    asked = (options.scene, options.preset, options.settings, options.swap, options.transport)
    scene, variants = load_variants(*asked)
    wanted = JsonFile(options.json, KEYS, kind=dict)
    if not variants.stability:
        raise SceneError(
            f"{scene.path.name}: there is no limit to be found. Add a [[stability]] for each."
        )
    name, files = scene.file.name, (NAME, PICTURE, REPORT)
    folder = options.out or Path("runs") / f"{name}-stability"
    with begin_series("stability", name, files, folder, options.force, keep=True) as place:
        _require_same(options, name, place.path)
        discard_former(place.path)
        stop = StopRequest()
        with stop.listening():
            limits = Searches(options, stop).find(options.scene, variants.stability, place.path)
        command = command_line("stability", *asked)
        content = _write(name, scene, limits, place.path, _asked(options), command)
        wanted.write(content)
        _show(content, place.path)
    return results.INTERRUPTED if stop() else _status(limits)


def _run_all(options: argparse.Namespace) -> int:
    """Find the limits of all scenes that come with quintet; what was found before is kept.

    Limits of one scene are found one after the other, several scenes at once.
    """
    refuse_with_all("stability", options)
    if options.jobs is None:
        options.jobs = SCENES_AT_ONCE
    if options.jobs < 1:
        raise SceneError(f"stability: --jobs must be 1 or more; found {options.jobs}. Correct it.")
    wanted = JsonFile(options.json, KEYS, kind=list)
    if options.readme:
        marked_place.LIMITS.check(options.readme)
    before = json.loads(options.json.read_text("utf-8") or "[]") if _is_there(options.json) else []
    content: dict[str, Row] = {entry["scene"]: entry for entry in before}
    # Every scene is checked before anything starts.
    scenes = {name: load_variants(name) for name in _cheapest_first()}
    content = {name: content[name] for name in scenes if name in content}
    folder, stop = share("stability", "all", (NAME,), options.out), StopRequest()
    with stop.listening(), ThreadPoolExecutor(options.jobs) as threads:
        for name in scenes:
            (folder / name).mkdir(exist_ok=True)
        searches = Searches(options, stop, named=True)
        futures = {
            threads.submit(searches.find, name, variants.stability, folder / name): name
            for name, (_, variants) in scenes.items()
        }
        failed = False
        try:
            for future in as_completed(futures):
                name, error = futures[future], future.exception()
                is_refused = isinstance(error, SceneError)
                if is_refused:
                    print(f"{name}: {error}", file=sys.stderr, flush=True)
                    failed = True
                if is_refused or stop():
                    continue  # the last of them may be incomplete
                row = (name, scenes[name][0], future.result(), folder / name, _asked(options))
                content[name] = _write(*row, command_line("stability", name))
                ordered = [content[scene] for scene in sorted(content)]
                wanted.write(ordered)
                write_whole(folder / NAME, json.dumps(ordered, indent=2))
                if options.readme:
                    marked_place.LIMITS.put(options.readme, "\n".join(markdown(ordered)))
                _show(content[name], folder / name)
        finally:
            threads.shutdown(cancel_futures=True)
    if stop():
        return results.INTERRUPTED
    if failed:
        return results.FAILED
    return _status([limit for scene in content.values() for limit in scene["limits"]])


def _asked(options: argparse.Namespace) -> Row:
    """What was asked for beside the scene itself."""
    return {"preset": options.preset, "settings": options.settings, "swaps": options.swap}


def _require_same(options: argparse.Namespace, scene: str, folder: Path) -> None:
    """Refuse a folder with limits of another scene or other settings, unless they are replaced."""
    path = folder / NAME
    if options.force or not path.is_file():
        return
    former = json.loads(path.read_text("utf-8"))
    if former["scene"] != scene or former.get("asked", _asked(options)) != _asked(options):
        raise SceneError(
            f"--out {folder}: it holds limits of {former['scene']} with other settings. Name "
            "another folder, or replace them with --force."
        )


def _is_there(path: Path | None) -> bool:
    return path is not None and path.is_file()


def _cheapest_first() -> list[str]:
    """Scenes that come with quintet and have limits, by the time that they take."""
    tables = {name: parse(path) for name, path in library().items()}
    minutes = {n: table.get("minutes", 0.0) for n, table in tables.items() if "stability" in table}
    return sorted(minutes, key=lambda name: (minutes[name], name))


def _write(
    name: str, scene: Scene, limits: list[Row], folder: Path, asked: Row, command: str
) -> Row:
    """Write the limits of a scene; return the content."""
    content = {
        "scene": name,
        "asked": asked,
        "units": units_of_keys(scene, _keys_of(limits)),
        "limits": limits,
        "machine": results.machine(),
        "command": command,
    }
    write_whole(folder / NAME, json.dumps(content, indent=2))
    return content


def _keys_of(limits: list[Row]) -> Iterator[str]:
    """Paths of the keys that limits are about."""
    for limit in limits:
        parameter = limit["parameter"]
        yield from [parameter] if isinstance(parameter, str) else ()  # a factor has no unit
        yield from limit["against"] or ()


def _show(content: Row, folder: Path) -> None:
    """Print the limits, and draw the maps of those in two parameters."""
    print_limits(content["limits"], content["units"], console())
    if drawn := draw_maps(content["scene"], content["limits"], content["units"], folder / PICTURE):
        print(f"drawn in {drawn}")


def _status(limits: list[Row]) -> int:
    """Exit status: 0 where every limit was found."""
    return results.DONE if all(limit["found"] is not None for limit in limits) else results.UNMET
