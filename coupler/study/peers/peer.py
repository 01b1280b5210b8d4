"""Runs of another program beside a study: each in a fresh folder, measured as the scene's runs.

A run leaves its log, the files of its curves and ``peer.json`` in a folder of the study; everything
else it writes is removed with the temporary folder in which it ran.
"""

import json
import os
import shutil
import sys
import tempfile
from collections.abc import Callable
from dataclasses import asdict, dataclass
from datetime import date
from pathlib import Path
from typing import Any

from quintet.coupler.files.disk import write_whole
from quintet.coupler.files.run_files import read_marker
from quintet.coupler.launch.processes import tail
from quintet.coupler.measures.evaluation import Outcome, evaluate_curve
from quintet.coupler.run.folder import begin, check_ours, discard_former
from quintet.coupler.run.results import machine
from quintet.coupler.scene.scene import Scene
from quintet.coupler.scene.study_table import Refinement
from quintet.coupler.scene.varied_tables import folder_name
from quintet.coupler.study.peers.outputs import cpu_in, curve_in, version_in
from quintet.coupler.study.peers.process import DONE, FAILED, Ended, executable, run_command
from quintet.coupler.study.peers.table import (
    PYTHON,
    PeerRunTable,
    PeerTable,
    filled,
    read_peer,
)
from quintet.coupler.study.row import row_of
from quintet.interfaces.errors import SceneError

KIND, NAME, LOG = "peer", "peer.json", "peer.log"
Row = dict[str, Any]


@dataclass(frozen=True, slots=True)
class Peer:
    """Another program on the problem of a scene."""

    name: str
    folder: Path  # of its inputs
    table: PeerTable
    scene: Scene

    @property
    def runs(self) -> tuple[PeerRunTable, ...]:
        """Its runs, coarse to fine."""
        return self.table.run

    def place(self, series: Path, run: PeerRunTable) -> Path:
        """Folder of a run within that of a study."""
        return series / folder_name(f"{self.name} {run.label}")

    def row(self, run: PeerRunTable, series: Path, stop: Callable[[], bool], keep: bool) -> Row:
        """Run the program, or take over what it left in this folder; return the row of the study.

        Parameters
        ----------
        run : PeerRunTable
        series : Path
            Folder of the study.
        stop : callable
            Whether to end early.
        keep : bool
            Take over a completed run of the same inputs and programs on the same machine.
        """
        place = self.place(series, run)
        result = _earlier(place, self._inputs(run)) if keep else None
        if result is None:
            files = [NAME, LOG, *{curve.file for curve in self.table.curve}]
            with begin(KIND, place.name, files, place, force=True):
                discard_former(place)
                result = self._carry_out(run, place, stop)
                write_whole(place / NAME, json.dumps(result, indent=2))
        return self._judged(run, place, result)

    def summary(self, rows: list[Row]) -> Row:
        """What ``study.json`` has of this program."""
        versions = [row["version"] for row in rows if row["version"]]
        return {
            "name": self.name,
            "program": self.table.program,
            "version": versions[0] if versions else "",
            "settings": self.table.settings,
            "source": self.table.source,
            "inputs": [str(self.folder / file) for file in self.table.inputs.values()],
            "cost": self.table.cost,
            "runs": len(self.runs),
            "rows": rows,
        }

    def _inputs(self, run: PeerRunTable) -> Row:
        """Everything that a run is made of, as it is kept beside its results."""
        values = {**run.values, PYTHON: sys.executable}
        texts = {
            place: filled((self.folder / file).read_text(), values)
            for place, file in self.table.inputs.items()
        }
        commands = [[filled(word, values) for word in command] for command in self.table.commands]
        table = self.table
        return {
            "inputs": texts,
            "commands": commands,
            "programs": [_installed(command[0]) for command in commands],
            "environment": table.environment,
            "timed": len(table.prepare),
            "cpu_table": asdict(table.cpu) if table.cpu else None,
            "curves": [asdict(curve) for curve in table.curve],
            "machine": machine(),
        }

    def _carry_out(self, run: PeerRunTable, place: Path, stop: Callable[[], bool]) -> Row:
        """Run all commands in a temporary folder; return status, costs and inputs."""
        begun = self._inputs(run)
        # A file that cannot be removed costs room, not the result.
        with tempfile.TemporaryDirectory(
            prefix="quintet-peer-", ignore_cleanup_errors=True
        ) as name:
            fresh = Path(name)
            for file, text in begun["inputs"].items():
                (fresh / file).parent.mkdir(parents=True, exist_ok=True)
                (fresh / file).write_text(text)
            about = {**load_of_machine(), "date": date.today().isoformat()}
            result = about | self._command_all(begun, fresh, place, stop)
            for curve in self.table.curve:
                if (fresh / curve.file).is_file():
                    shutil.copyfile(fresh / curve.file, place / curve.file)
        return {**result, **begun}

    def _command_all(self, begun: Row, fresh: Path, place: Path, stop: Callable[[], bool]) -> Row:
        """Run the commands one after the other, to the first that fails."""
        costs, log, left = Ended(DONE, 0), place / LOG, 60.0 * self.table.minutes
        printed = ""
        for number, command in enumerate(begun["commands"]):
            size = log.stat().st_size if log.is_file() else 0
            words = [executable(command[0]) or command[0], *command[1:]]
            ended = run_command(words, fresh, log, left, stop, self.table.environment)
            left -= ended.wall
            if number == begun["timed"]:
                costs = ended
                printed = log.read_bytes()[size:].decode(errors="replace")
            if ended.status != DONE:
                cause = f"{command[0]}: {ended.status}, exit status {ended.exit}: "
                return _costs(ended) | {"cause": cause + " ".join(tail(log)[-3:]), "version": ""}
        whole = log.read_text(errors="replace")
        row = {**_costs(costs), "version": version_in(whole, self.table.version)}
        try:
            return row | {"cpu": cpu_in(printed, self.table.cpu)} if self.table.cpu else row
        except SceneError as error:
            return row | {"status": FAILED, "cause": str(error)}

    def _judged(self, run: PeerRunTable, place: Path, result: Row) -> Row:
        """Row of a run: errors by the expectations of the scene."""
        outcomes: list[Outcome] = []
        if result["status"] == DONE:
            try:
                outcomes = self._outcomes(place)
            except SceneError as error:
                result = result | {"status": FAILED, "cause": str(error)}
        names = ("wall", "cpu", "memory")
        wall, cpu, memory = (result[name] for name in names)
        parts = {"cpu": cpu, "compute": wall, "items": 0, "memory": memory}
        timing = {"wall": wall, "memory": memory, "exchange": 0.0, "mapping": 0.0}
        row = row_of(
            Refinement(run.label, dict(run.values)),
            {
                "status": result["status"],
                "expect": [asdict(outcome) for outcome in outcomes],
                "timing": {**timing, "components": {self.name: parts}},
            },
        )
        more = ("cpu_process", "load", "cores", "date", "version", "cause")
        return row | {name: result.get(name, "") for name in more} | {"series": run.series}

    def _outcomes(self, place: Path) -> list[Outcome]:
        """Outcomes of the expectations that its curves serve."""
        return [
            evaluate_curve(expectation, curve_in(place / curve.file, curve), self.scene.folder)
            for expectation in self.scene.expect
            for curve in self.table.curve
            if curve.serves(expectation)
        ]


def load_of_machine() -> Row:
    """Load of this machine, and on how many cores."""
    return {"load": os.getloadavg()[0], "cores": os.cpu_count()}


def _installed(word: str) -> Row:
    """Path of a program and when its file changed, which tells one version from another."""
    path = executable(word)
    return {"path": path, "changed": os.stat(path).st_mtime_ns if path else None}


def _costs(ended: Ended) -> Row:
    """Status and costs of the command that is timed."""
    return {
        "status": ended.status,
        "wall": ended.wall,
        "cpu": ended.cpu,
        "cpu_process": ended.cpu,
        "memory": ended.memory,
    }


def _earlier(place: Path, begun: Row) -> Row | None:
    """Results of a completed run of the same inputs and programs; None if there are none."""
    marker = read_marker(place) if place.is_dir() else None
    if marker is None or not (place / NAME).is_file():
        return None
    check_ours(place, KIND)
    result: Row = json.loads((place / NAME).read_text(encoding="utf-8"))
    same = all(result.get(key) == value for key, value in json.loads(json.dumps(begun)).items())
    return result if same and result["status"] == DONE else None


def read_peers(names: list[str], scene: Scene) -> list[Peer]:
    """Find the programs that are to run beside a study, all of which must be installed.

    Raises
    ------
    SceneError
        The scene has no inputs for one, or it is not installed; says how to install it.
    """
    peers = []
    for name in dict.fromkeys(names):
        folder, table = read_peer(scene.folder, name, scene.expect)
        programs = [command[0] for command in table.commands]
        missing = sorted({p for p in programs if p != f"@{PYTHON}@" and executable(p) is None})
        if missing:
            raise SceneError(
                f"--beside {name}: {table.program} must be installed; there is no program "
                f"{', '.join(missing)}. Install it: {table.install}"
            )
        peers.append(Peer(name, folder, table, scene))
    return peers
