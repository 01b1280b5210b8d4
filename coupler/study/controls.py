"""``quintet controls SCENE``: whether the tolerances of a scene reject wrong settings.

Every run lies in a folder that is named after its hash: started again, the command runs only what
is not complete. What a run without a wrong setting gives is the business of ``quintet run``.
"""

import argparse
import json
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from quintet.coupler.files.json_file import JsonFile
from quintet.coupler.report.control_tables import markdown, screen_table
from quintet.coupler.report.show import console
from quintet.coupler.run import results
from quintet.coupler.run.folder import share
from quintet.coupler.run.signals import StopRequest
from quintet.coupler.scene.control_table import Control
from quintet.coupler.scene.overrides import assignments
from quintet.coupler.scene.read import library, load, load_variants, parse
from quintet.coupler.scene.scene import Scene
from quintet.coupler.study.control_judgement import judge, status_of, without_control
from quintet.coupler.study.run_hash import run_hash
from quintet.coupler.study.sweep_run import ELSEWHERE, JOURNAL, KEPT, Job, carry_out
from quintet.interfaces.errors import SceneError

NAME = "controls"  # of the folder in runs
KEYS = ("scene", "rows")  # of the file for programs
TRANSPORT = "memory"  # of runs, if none is given
AGAIN = 1.0  # s until a run that another process does is looked at again
Row = dict[str, Any]


@dataclass(slots=True)
class Controls:
    """Runs of controls, in one folder.

    Attributes
    ----------
    folder : Path
        With a folder for each run.
    transport : str
        Of the runs.
    stop : callable
        Whether to end early.
    runs : dict
        Results of the runs that are known, by hash.
    """

    folder: Path
    transport: str
    stop: Callable[[], bool]
    runs: dict[str, Row] = field(default_factory=dict)

    def scene_rows(self, asked: str, scene: Scene, controls: list[Control]) -> Iterator[Row]:
        """Run the controls of a scene; yield a row for each expectation of each."""
        named = {name for control in controls for name in control.table.rejects}
        for control in controls:
            preset, base = control.table.preset, None
            if control.has_base:
                base = self._run(asked, preset, control.base_settings)
            run = self._run(asked, preset, control.settings)
            for name in control.table.rejects:
                yield judge(control.table.name, name, run, base)
        yield from (without_control(e.name) for e in scene.expect if e.name not in named)

    def _run(self, asked: str, preset: str, settings: Row) -> Row:
        """Results of one run: known, found complete, or run now."""
        if self.stop():
            return {"status": "not run"}
        scene = load(asked, preset, assignments(settings), (), self.transport)
        job = Job(
            run_hash(scene), self.folder, (asked, preset, [], [], self.transport), settings,
            scene.resolved, results.machine()["versions"],
        )  # fmt: skip
        if job.name not in self.runs:
            run = carry_out(job, self.stop)
            while run["status"] == ELSEWHERE and not self.stop():
                time.sleep(AGAIN)
                run = carry_out(job, self.stop)
            label = " ".join(word for word in (scene.file.name, preset) if word)
            outcome = "found complete" if run.get(KEPT) else run["status"]
            print(f"{label}: {', '.join(assignments(_own(settings)))}: {outcome}", flush=True)
            self.runs[job.name] = run
        return self.runs[job.name]


def _own(settings: Row) -> Row:
    """Settings without those of the output."""
    return {path: value for path, value in settings.items() if not path.startswith("output.")}


def run_controls(options: argparse.Namespace) -> int:
    """Run the controls of a scene, or of all scenes; return the exit status."""
    if [options.all, options.scene is not None, options.show is not None].count(True) != 1:
        raise SceneError("controls needs one of a scene, --all and --show. Give one of them.")
    if options.show:
        return _show(options.show)
    wanted = JsonFile(options.json, KEYS)
    content = _scenes_of(options.json)
    # Every scene is checked before anything starts.
    scenes = {name: load_variants(name) for name in _names(options)}
    out = options.out or Path("runs") / NAME
    folder, stop = share("controls", NAME, (JOURNAL,), out), StopRequest()
    runs = Controls(folder, options.transport or TRANSPORT, stop)
    rows: list[Row] = []
    with stop.listening():
        for asked, (scene, variants) in scenes.items():
            new = list(runs.scene_rows(asked, scene, variants.control))
            rows += new
            console().print(screen_table(scene.file.name, new))
            _tell(scene.file.name, new)
            content[scene.file.name] = {"scene": scene.file.name, "rows": new}
            if stop():
                break
            wanted.write([content[name] for name in sorted(content)])
    return results.INTERRUPTED if stop() else status_of(rows)


def _names(options: argparse.Namespace) -> list[str]:
    """The scene that is asked for, or all that come with quintet, cheapest first."""
    if not options.all:
        return [options.scene]
    minutes = {name: parse(path).get("minutes", 0.0) for name, path in library().items()}
    return sorted(minutes, key=lambda name: (minutes[name], name))


def _scenes_of(path: Path | None) -> dict[str, Row]:
    """Scenes in a file that this command left before."""
    text = path.read_text(encoding="utf-8") if path and path.is_file() else ""
    return {entry["scene"]: entry for entry in (json.loads(text) if text else [])}


def _show(path: Path) -> int:
    """Print the table of a file that this command left; return the exit status."""
    if not path.is_file():
        raise SceneError(f"--show {path}: there is no such file. Make it with --json {path}.")
    JsonFile(path, KEYS, "--show")
    scenes = _scenes_of(path)
    for line in markdown(scenes.values()):
        print(line)
    return status_of(row for scene in scenes.values() for row in scene["rows"])


def _tell(scene: str, rows: list[Row]) -> None:
    """Print what is wrong, in sentences."""
    for row in rows:
        if row["cause"]:
            control = f", control {row['control']}" if row["control"] else ""
            line = f"{scene}: expectation {row['expectation']}{control}: {row['cause']}"
            console().print(line, markup=False, highlight=False)
