"""Connecting the components of a scene: in memory, over zenoh or over MPI."""

import contextlib
import os
import secrets
import shlex
import socket
import time
from functools import partial
from pathlib import Path
from typing import Any, Protocol

from quintet.coupler.coupling.participant import LONGEST_WAIT, ComponentFailed, Participant
from quintet.coupler.launch import stack
from quintet.coupler.launch.acceptance import accept, log_of, probe_of, settings
from quintet.coupler.launch.mpi_job import (
    find_launcher,
    under_shell,
    write_processes,
)
from quintet.coupler.launch.process_probe import ProcessProbe
from quintet.coupler.launch.processes import GRACE, RUN, end_marked, start
from quintet.coupler.launch.watchdog import Watchdog
from quintet.coupler.scene.overrides import run_arguments
from quintet.coupler.scene.read import library
from quintet.coupler.scene.scene import ComponentPlan, Scene
from quintet.interfaces.component import Component
from quintet.interfaces.errors import LineError, QuintetError, SceneError
from quintet.interfaces.lines.endpoint import Security
from quintet.interfaces.serving.malloc import keep_freed_memory
from quintet.interfaces.serving.process import build, shared_files
from quintet.interfaces.serving.serve import Server, answer, failure

JOINING_BY_HAND = 3600.0  # s until a component says hello that somebody starts elsewhere
ABORTING = 0.2  # s for components to end by themselves when a run fails


class Connection(Protocol):
    """Components joined to the coupler."""

    participants: dict[str, Participant]

    def close(self, well: bool) -> None:
        """Close all connections; components finish in order if all is well, else they are ended."""

    def notes(self) -> list[str]:
        """What the user should know of the connections."""


def connect(scene: Scene, folder: Path, watchdog: Watchdog) -> Connection:
    """Start and join all components of a scene, over its transport; have them watched."""
    keep_freed_memory()
    if scene.transport == "memory":
        return InMemory(scene, watchdog)
    if scene.transport == "mpi":
        return OverMpi(scene, folder, watchdog)
    return OverZenoh(scene, folder, watchdog)


class InMemory:
    """All components in the coupler's own process."""

    def __init__(self, scene: Scene, watchdog: Watchdog) -> None:
        # Only the transport that a run uses is loaded.
        from quintet.interfaces.lines.memory import MemoryLine

        self.participants: dict[str, Participant] = {}
        self.watchdog = watchdog
        run = secrets.token_hex(4)
        try:
            for name, plan in scene.components.items():
                line = MemoryLine(run, name)
                participant = self.participants[name] = Participant(name, line)
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
        raise ComponentFailed(plan.name, 0, report["text"], report["traceback"]) from error


class OverZenoh:
    """One process per component, started here or joined by hand."""

    def __init__(self, scene: Scene, folder: Path, watchdog: Watchdog) -> None:
        # Only the transport that a run uses is loaded: zenoh starts threads.
        from quintet.interfaces.lines.admission import Admission, ForeignMessages
        from quintet.interfaces.lines.zenoh import Session, ZenohLine

        endpoint = scene.endpoint or f"tcp/127.0.0.1:{free_port()}"
        self.participants: dict[str, Participant] = {}
        self.watchdog = watchdog
        self.probes: dict[str, ProcessProbe] = {}
        self.secret = secrets.token_hex(16)
        try:
            self.session = Session(endpoint, True, "coupler", scene.security, self.secret)
        except LineError as error:
            raise SceneError(f"scene.{error}. Name another endpoint, or give none.") from error
        self.foreign = ForeignMessages(self.session.zenoh)
        kinds = {name: plan.manifest.kind for name, plan in scene.components.items()}
        awaited = {name: kind for name, kind in kinds.items() if name in scene.elsewhere}
        self.admission = Admission(
            self.session.zenoh, self.secret, awaited, kinds.keys() - awaited.keys(), self.foreign
        )
        watchdog.news = self.foreign.look
        self.run = watchdog.mark
        lines = {name: ZenohLine(self.session, self.run, name) for name in scene.components}
        try:
            if scene.security and kinds.keys() - awaited.keys():
                require_reachable(endpoint, scene.security)
            for name, line in lines.items():
                self.probes[name] = probe_of(scene, name, awaited=name in awaited)
                if name in scene.elsewhere:
                    print(f"{name} is awaited: {join_command(scene, name, endpoint)}", flush=True)
                else:
                    self._start(scene, name, endpoint, folder)
                self.participants[name] = Participant(name, line)
                self.watchdog.add(self.participants[name], self.probes[name], scene.patience(name))
            for name, line in lines.items():
                seconds = JOINING_BY_HAND if name in scene.elsewhere else LONGEST_WAIT
                hello = self.participants[name].await_hello(seconds, line.wait_for_partner)
                accept(scene, self.participants[name], hello, self.probes[name], folder, 0)
        except BaseException:
            self.close(False)
            raise

    def _start(self, scene: Scene, name: str, endpoint: str, folder: Path) -> None:
        plan = scene.components[name]
        arguments = [
            "-m",
            "quintet.interfaces.serving.process",
            plan.kind,
            "--name",
            name,
            "--at",
            endpoint,
        ]
        if scene.tls:
            arguments += ["--tls", *scene.tls]
        for place in scene.import_folders:
            arguments += ["--look-in", place]
        launcher: list[str] = []
        if plan.ranks > 1:
            arguments = ["-m", "mpi4py", *arguments, "--ranks", str(plan.ranks)]
            arguments += ["--log", str(log_of(folder, name))]
            launcher = [*find_launcher(), "-n", str(plan.ranks)]
            launcher += under_shell(folder, name, plan.ranks)
        process = start(
            arguments, log_of(folder, name), plan.threads, self.run, self.secret, launcher
        )
        self.probes[name].pid, self.probes[name].process = process.pid, process

    def close(self, well: bool) -> None:
        """See `Connection.close`."""
        self.watchdog.expect_ends()
        end_all(self.participants, list(self.probes.values()), well, self.watchdog)
        self.watchdog.close()
        self.watchdog.news = lambda: ""
        end_marked(RUN, self.run)
        self.session.close()

    def notes(self) -> list[str]:
        """See `Connection.notes`."""
        return self.foreign.summary()


def require_reachable(endpoint: str, security: Security) -> None:
    """Refuse certificates with which the components that are started here could not connect."""
    # Only runs over zenoh with certificates look at them.
    from quintet.interfaces.lines.reach import obstacle

    hindrance = obstacle(endpoint, security)
    if hindrance.text and hindrance.certain:
        raise SceneError(f"scene.endpoint {endpoint}: {hindrance.text}")


def join_command(scene: Scene, name: str, endpoint: str) -> str:
    """Command that starts a component elsewhere and joins it to the coupler at an endpoint."""
    known = library().get(scene.path.parent.name)
    name_or_path = {"scene": scene.path.parent.name} if known == scene.path else {}
    asked = run_arguments(**{**scene.asked, **name_or_path})
    return shlex.join(["quintet", "join", *asked, name, "--at", endpoint])


class OverMpi:
    """One rank per component; this process is rank 0."""

    def __init__(self, scene: Scene, folder: Path, watchdog: Watchdog) -> None:
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
                participant = Participant(name, mpi.MpiLine(run, "coupler", name, first))
                probe = self.probes[name] = probe_of(scene, name, folder)
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
            finish(self.participants)
        self.watchdog.close()
        if not well:
            # A dead rank would keep MPI from ending in order: end the others ourselves.
            for probe in self.probes.values():
                probe.end(0.0)

    def notes(self) -> list[str]:
        """See `Connection.notes`."""
        return []


def finish(participants: dict[str, Participant]) -> None:
    """Order every component to finish, and await its answer."""
    for participant in participants.values():
        participant.send_order("finish")
    for participant in participants.values():
        used = participant.receive().header
        participant.timing.memory = int(used["memory"])
        participant.timing.cpu += float(used["cpu"])


def end_all(
    participants: dict[str, Participant], probes: list[ProcessProbe], well: bool, dog: Watchdog
) -> None:
    """End all component processes: in order, or at once."""
    if well:
        finish(participants)
    elif dog.verdict:  # some may not listen any more
        for probe in probes:
            probe.kill()
    else:
        for participant in participants.values():
            with contextlib.suppress(QuintetError):
                participant.line.send({"order": "abort"}, {})
    limit = time.monotonic() + (GRACE if well and not dog.stop() else ABORTING)
    for probe in probes:
        probe.end(max(0.0, limit - time.monotonic()))


def free_port() -> int:
    """Return a free port of the loopback."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])
