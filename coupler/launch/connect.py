"""Connecting the components of a scene: in memory, over zenoh or over MPI."""

import os
import secrets
import time
from functools import partial
from pathlib import Path
from typing import Any, Protocol

from quintet.coupler.coupling.participant import (
    LONGEST_WAIT,
    ComponentFailed,
    Participant,
    finish_all,
)
from quintet.coupler.launch import stack
from quintet.coupler.launch.acceptance import accept, probe_of, settings
from quintet.coupler.launch.disturbance import UNDISTURBED, Disturbance
from quintet.coupler.launch.mpi_job import write_processes
from quintet.coupler.launch.process_probe import ProcessProbe
from quintet.coupler.launch.watchdog import Watchdog
from quintet.coupler.scene.scene import ComponentPlan, Scene
from quintet.interfaces.component import Component
from quintet.interfaces.errors import SceneError
from quintet.interfaces.serving.failing import failure
from quintet.interfaces.serving.malloc import keep_freed_memory
from quintet.interfaces.serving.process import build, shared_files
from quintet.interfaces.serving.serve import Server, answer


class Connection(Protocol):
    """Components joined to the coupler."""

    participants: dict[str, Participant]

    def close(self, well: bool) -> None:
        """Close all connections; components finish in order if all is well, else they are ended."""

    def notes(self) -> list[str]:
        """What the user should know of the connections."""


def connect(
    scene: Scene, folder: Path, watchdog: Watchdog, disturbance: Disturbance = UNDISTURBED
) -> Connection:
    """Start and join all components of a scene, over its transport; have them watched."""
    keep_freed_memory()
    if scene.transport == "memory":
        return InMemory(scene, watchdog, disturbance)
    if scene.transport == "mpi":
        return OverMpi(scene, folder, watchdog, disturbance)
    # Only the transport that a run uses is loaded: zenoh starts threads.
    from quintet.coupler.launch.over_zenoh import OverZenoh

    return OverZenoh(scene, folder, watchdog, disturbance)


class InMemory:
    """All components in the coupler's own process."""

    def __init__(
        self, scene: Scene, watchdog: Watchdog, disturbance: Disturbance = UNDISTURBED
    ) -> None:
        # Only the transport that a run uses is loaded.
        from quintet.interfaces.lines.memory import MemoryLine

        self.participants: dict[str, Participant] = {}
        self.watchdog = watchdog
        run = secrets.token_hex(4)
        try:
            for name, plan in scene.components.items():
                line = MemoryLine(run, name)
                through = disturbance.line(name, line, list)
                participant = self.participants[name] = Participant(name, through)
                probe = ProcessProbe(name, os.getpid(), where=stack.of_main_thread)
                self.watchdog.add(participant, probe, scene.patience(name))
                began = time.perf_counter()
                with participant.keeping_others_waiting:
                    component = _built(plan, settings(scene, name))
                server = Server(component, name, time.perf_counter() - began)
                line.handle = partial(answer, server, line.far)
        except BaseException:
            self.watchdog.close()
            raise

    def close(self, well: bool) -> None:
        """See `Connection.close`."""
        self.watchdog.close()

    def notes(self) -> list[str]:
        """See `Connection.notes`."""
        return []


def _built(plan: ComponentPlan, header: dict[str, Any]) -> Component:
    try:
        return build(plan.manifest, header)
    except SceneError as error:
        raise SceneError(f"components.{plan.name}: {error}") from error
    except (Exception, SystemExit) as error:
        report = failure(error)
        cause = f"{report['error']}: {report['text']}"
        raise ComponentFailed(plan.name, 0, cause, report["traceback"]) from error


class OverMpi:
    """One rank per component; this process is rank 0."""

    def __init__(
        self, scene: Scene, folder: Path, watchdog: Watchdog, disturbance: Disturbance = UNDISTURBED
    ) -> None:
        # Only the transport that a run uses is loaded: mpi4py starts MPI.
        from quintet.interfaces.lines import mpi

        mpi.self_check(1 + sum(plan.ranks for plan in scene.components.values()))
        run = secrets.token_hex(4)
        self.participants: dict[str, Participant] = {}
        self.watchdog = watchdog
        self.probes: dict[str, ProcessProbe] = {}
        write_processes(folder, None, shared_files())
        try:
            for name in scene.components:
                first = scene.first_rank(name)
                line = mpi.MpiLine(run, "coupler", name, first)
                probe = self.probes[name] = probe_of(scene, name, folder)
                participant = Participant(name, disturbance.line(name, line, probe.pids))
                self.watchdog.add(participant, probe, scene.patience(name))
                hello = participant.await_hello(LONGEST_WAIT, lambda seconds: None)
                self.participants[name] = participant
                accept(scene, participant, hello, probe, folder, first)
        except BaseException:
            self.close(False)
            raise
        pids = [pid for probe in self.probes.values() for pid in probe.pids()]
        shared = [path for probe in self.probes.values() for path in probe.shared]
        write_processes(folder, pids, [*shared_files(), *shared])

    def close(self, well: bool) -> None:
        """See `Connection.close`."""
        self.watchdog.expect_ends()
        if well:
            finish_all(self.participants)
        self.watchdog.close()
        if not well:
            # A dead rank would keep MPI from ending in order: end the others ourselves.
            for probe in self.probes.values():
                probe.end(0.0)

    def notes(self) -> list[str]:
        """See `Connection.notes`."""
        return []
