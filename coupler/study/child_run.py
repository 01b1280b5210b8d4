"""Runs of one scene with overrides, each in a child process.

A run that crashes or hangs does not affect the others; and its memory, threads and compiled
kernels are its own, so that run times can be compared.
"""

import argparse
import contextlib
import os
import signal
import subprocess
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from quintet.coupler.files.run_files import RUN_LOG as LOG
from quintet.coupler.files.run_files import SCENE
from quintet.coupler.launch.processes import PYTHON, tail
from quintet.coupler.report.show import NAME, results
from quintet.coupler.run.folder import begin, check_ours, discard_former
from quintet.coupler.run.results import BAD, machine
from quintet.coupler.run.signals import StopRequest
from quintet.coupler.scene.overrides import assignments, run_arguments
from quintet.coupler.scene.read import load, parse
from quintet.coupler.scene.scene import Scene
from quintet.coupler.study.run_hash import run_hash
from quintet.interfaces.errors import SceneError
from quintet.interfaces.serving.process import STARTER

HASH = "run "  # before the hash, in the log
GRACE = 10.0  # s for a run to end after SIGTERM
FOREVER = float("inf")


@dataclass(frozen=True, slots=True)
class ChildRun:
    """A scene and its overrides, as on the command line, to be run in child processes."""

    scene: str
    preset: str
    settings: list[str]
    swaps: list[str]
    transport: str
    stop: Callable[[], bool]  # whether to end the run early
    force: bool = False  # replace former runs
    hashed: bool = False  # the log begins with the run's hash, by which `earlier` knows it

    @classmethod
    def of(cls, options: argparse.Namespace, stop: StopRequest, transport: str = "") -> "ChildRun":
        """Take scene and overrides from the command line; its transport takes precedence."""
        asked = (options.scene, options.preset, options.settings, options.swap)
        again = options.force or getattr(options, "keep", False)
        return cls(*asked, options.transport or transport, stop, again, hashed=True)

    def run(self, settings: dict[str, Any], folder: Path, seconds: float = FOREVER) -> Any:
        """Run with these settings; return the results, of status stalled if it timed out."""
        with begin("run", folder.name, [LOG], folder, self.force):
            discard_former(folder)  # the scene and all its variants were checked
        target, head = ["--out", str(folder), "--force"], ""
        if self.hashed:
            with contextlib.suppress(SceneError):  # the run reports it
                head = f"{HASH}{run_hash(self._load(settings))}\n"
        return self._start(self._command(settings, target), folder, "wb", seconds, head)

    def resume(self, settings: dict[str, Any], folder: Path) -> Any:
        """Go on with a run from its last snapshot; of status refused if it has none of use."""
        check_ours(folder, "run")
        command = self._command(settings, ["--resume", str(folder)])
        return self._start(command, folder, "ab", FOREVER)

    def _start(
        self, command: list[str], folder: Path, mode: str, seconds: float, head: str = ""
    ) -> Any:
        """Run a command in a process of its own, its output in the log; return the results.

        They have the exit status of the process, that of a signal negative, under `exit`.
        """
        with open(folder / LOG, mode) as log:
            log.write(head.encode())
            log.flush()
            process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
                start_new_session=True,  # signals of the terminal come to us alone
                env={**os.environ, STARTER: str(os.getpid())},
            )
        try:
            stalled = self._await(process, seconds)
        finally:
            with contextlib.suppress(ProcessLookupError):
                process.kill()
            process.wait()
        return {**_results(folder, process.returncode, stalled), "exit": process.returncode}

    def earlier(self, settings: dict[str, Any], folder: Path) -> Any:
        """Results of the same run, done in an earlier series; None if there are none.

        It must be of the scene and its files as they are read now, on this machine with these
        versions.
        """
        if not (folder / NAME).is_file():
            return None
        run = results(folder)
        try:
            scene = self._load(settings)
        except SceneError:  # the scene has changed, and refuses now what it took before
            return None
        same = parse(folder / SCENE) == scene.resolved
        same = same and _hash_in(folder / LOG) == run_hash(scene)
        if same and scene.beginning:
            # Only scenes that begin from another run load HDF5.
            from quintet.coupler.files.states import hash_of

            same = run.get("begin_from", {}).get("hash") == hash_of(scene.beginning.path)
        done = same and run.get("status") == "done" and run.get("machine") == machine()
        return run if done else None

    def _load(self, settings: dict[str, Any]) -> Scene:
        return load(self.scene, self.preset, self._overrides(settings), self.swaps, self.transport)

    def _overrides(self, settings: dict[str, Any]) -> list[str]:
        return [*self.settings, *assignments(settings)]

    def _command(self, settings: dict[str, Any], target: list[str]) -> list[str]:
        overrides = self._overrides(settings)
        asked = run_arguments(self.scene, self.preset, overrides, self.swaps, self.transport)
        python = [*PYTHON, "-m", "quintet.coupler.cli"]
        return [*python, "run", *asked, *target]

    def _await(self, process: "subprocess.Popen[bytes]", seconds: float) -> bool:
        """Wait for the process to end; return whether it timed out."""
        limit, asked, stalled = time.monotonic() + seconds, FOREVER, False
        while process.poll() is None:
            now = time.monotonic()
            if asked == FOREVER and (self.stop() or now > limit):
                stalled = not self.stop()
                asked = now
                process.send_signal(signal.SIGTERM)
            if now > asked + GRACE:
                break
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(0.1)
        return stalled


def _hash_in(log: Path) -> str:
    """Hash of the run with which its log begins; empty where it does not."""
    try:
        with open(log, encoding="utf-8", errors="replace") as file:
            line = file.readline().rstrip("\n")
    except OSError:
        return ""
    return line.removeprefix(HASH) if line.startswith(HASH) else ""


def _results(folder: Path, status: int, stalled: bool) -> Any:
    """Read the results of a run; without any it failed."""
    if (folder / NAME).is_file():
        run = results(folder)
    else:
        lines = tail(folder / LOG)
        state = "refused" if status == BAD else "failed"
        cause = " ".join(lines[-3:])
        if status != BAD:
            cause = f"the run ended with status {status} and left no results: {cause}"
        run = {"status": state, "windows": 0, "time": 0.0, "fault": {"cause": cause}}
    return run | {"status": "stalled"} if stalled else run
