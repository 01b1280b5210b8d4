"""Connecting the components of a scene: in memory, over zenoh or over MPI."""

import contextlib
import secrets
import socket
import time
import traceback
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from quintet.coupler.coupling.participant import ComponentFailed, Participant
from quintet.coupler.launch.mpi_job import write_processes
from quintet.coupler.launch.processes import GRACE, Watch, start
from quintet.coupler.scene.scene import Scene
from quintet.interfaces.errors import LineError, QuintetError, SceneError
from quintet.interfaces.lines.message import Message
from quintet.interfaces.lines.transport import FramedLine
from quintet.interfaces.serving.malloc import keep_freed_memory
from quintet.interfaces.serving.process import build, shared_files
from quintet.interfaces.serving.serve import Server, answer

if TYPE_CHECKING:
    from quintet.interfaces.lines.zenoh import ZenohLine

JOINING = 180.0  # s until a component that we started says hello
JOINING_BY_HAND = 3600.0  # s until one does that somebody starts elsewhere


class Connection(Protocol):
    """Components joined to the coupler."""

    participants: dict[str, Participant]

    def close(self, well: bool) -> None:
        """Close all connections; components finish in order if all is well, else they are ended."""


def connect(scene: Scene, folder: Path, interrupted: Callable[[], bool]) -> Connection:
    """Start and join all components of a scene, over its transport."""
    keep_freed_memory()
    if scene.transport == "memory":
        return InMemory(scene)
    if scene.transport == "mpi":
        return OverMpi(scene, folder, interrupted)
    return OverZenoh(scene, folder, interrupted)


def settings(scene: Scene, name: str) -> dict[str, Any]:
    """Header of the order that gives a component its parameters."""
    one = scene.components[name]
    folder = str(scene.folder.resolve())
    return {"order": "go", "params": one.params, "threads": one.threads, "folder": folder}


class InMemory:
    """All components in the coupler's own process."""

    def __init__(self, scene: Scene) -> None:
        # Only the transport that a run uses is loaded.
        from quintet.interfaces.lines.memory import MemoryLine

        self.participants: dict[str, Participant] = {}
        run = secrets.token_hex(4)
        for name, one in scene.components.items():
            try:
                component = build(one.manifest, settings(scene, name))
            except SceneError as error:
                raise SceneError(f"components.{name}: {error}") from error
            except (Exception, SystemExit) as error:
                trace = "" if isinstance(error, QuintetError) else traceback.format_exc()
                raise ComponentFailed(name, 0, str(error), trace) from error
            line = MemoryLine(run, name)
            line.handle = partial(answer, Server(component, name), line.far)
            self.participants[name] = Participant(name, line)

    def close(self, well: bool) -> None:
        """See `Connection.close`."""


class OverZenoh:
    """One process per component, started here or joined by hand."""

    def __init__(self, scene: Scene, folder: Path, interrupted: Callable[[], bool]) -> None:
        # Only the transport that a run uses is loaded: zenoh starts threads.
        from quintet.interfaces.lines.zenoh import Session, ZenohLine

        endpoint = scene.endpoint or f"tcp/127.0.0.1:{free_port()}"
        self.participants: dict[str, Participant] = {}
        self.watches: dict[str, Watch] = {}
        try:
            self.session = Session(endpoint, True, "coupler", scene.security)
        except LineError as error:
            raise SceneError(f"scene.{error}. Name another endpoint, or give none.") from error
        run = secrets.token_hex(4)
        lines = {name: ZenohLine(self.session, run, name) for name in scene.components}
        try:
            for name in scene.components:
                if name not in scene.elsewhere:
                    self._start(scene, name, endpoint, folder)
            for name, line in lines.items():
                self._await_hello(scene, name, line, interrupted)
        except BaseException:
            self.close(False)
            raise

    def _start(self, scene: Scene, name: str, endpoint: str, folder: Path) -> None:
        one = scene.components[name]
        arguments = [
            "-m",
            "quintet.interfaces.serving.process",
            one.kind,
            "--name",
            name,
            "--at",
            endpoint,
        ]
        if scene.tls:
            arguments += ["--tls", *scene.tls]
        for place in scene.import_folders:
            arguments += ["--look-in", place]
        log = folder / "log" / f"{name}.log"
        process = start(arguments, log, one.threads)
        self.watches[name] = Watch(name, process.pid, process)

    def _await_hello(
        self, scene: Scene, name: str, line: "ZenohLine", interrupted: Callable[[], bool]
    ) -> None:
        watch = self.watches.get(name)
        # Before its first message a component imports and connects, and may compute little.
        line.watch = lambda: (
            "the run was interrupted"
            if interrupted()
            else ("" if watch is None or watch.alive() else watch.ending())
        )
        seconds = JOINING if watch else JOINING_BY_HAND
        try:
            line.wait_for_partner(seconds)
            hello = line.receive(seconds)
        except LineError as error:
            raise ComponentFailed(name, 0, f"did not join: {error}") from error
        accept(scene, name, line, hello, watch, self.participants)

    def close(self, well: bool) -> None:
        """See `Connection.close`."""
        end_all(self.participants, list(self.watches.values()), well)
        self.session.close()


class OverMpi:
    """One rank per component; this process is rank 0."""

    def __init__(self, scene: Scene, folder: Path, interrupted: Callable[[], bool]) -> None:
        # Only the transport that a run uses is loaded: mpi4py starts MPI.
        from quintet.interfaces.lines import mpi

        mpi.self_check(1 + len(scene.components))
        run = secrets.token_hex(4)
        self.participants: dict[str, Participant] = {}
        self.watches: dict[str, Watch] = {}
        write_processes(folder, None, shared_files())
        for rank, name in enumerate(scene.components, start=1):
            line = mpi.MpiLine(run, "coupler", name, rank)
            line.watch = lambda: "the run was interrupted" if interrupted() else ""
            try:
                hello = line.receive(JOINING)
            except LineError as error:
                raise ComponentFailed(name, 0, f"did not join: {error}") from error
            here = hello.header.get("host") == socket.gethostname()
            watch = Watch(name, int(hello.header["pid"])) if here else None
            if watch:
                self.watches[name] = watch
            accept(scene, name, line, hello, watch, self.participants)
        watches = self.watches.values()
        shared = [path for watch in watches for path in watch.shared]
        write_processes(folder, [watch.pid for watch in watches], [*shared_files(), *shared])

    def close(self, well: bool) -> None:
        """See `Connection.close`."""
        if well:
            finish(self.participants)
            return
        # A dead rank would keep MPI from ending in order: end the others ourselves.
        for watch in self.watches.values():
            watch.end(0.0)


def accept(
    scene: Scene,
    name: str,
    line: FramedLine,
    hello: Message,
    watch: Watch | None,
    participants: dict[str, Participant],
) -> None:
    """Accept a component: check its kind, watch its process, send its parameters."""
    expected = scene.components[name].manifest.kind
    if hello.order != "hello" or hello.header.get("kind") != expected:
        raise ComponentFailed(
            name, 0, f"{expected} must say hello; found {hello.header.get('kind')!r}. Start that."
        )
    one = participants[name] = Participant(name, line)
    if watch:
        told = map(Path, map(str, hello.header.get("shared", [])))
        watch.shared = [str(path) for path in told if path.parent == Path("/dev/shm")]
        watch.usual = lambda: one.timing.usual
        line.watch, one.asking = watch, watch.reset
    line.send(settings(scene, name), {})


def finish(participants: dict[str, Participant]) -> None:
    """Order every component to finish, and await its answer."""
    for one in participants.values():
        one.send_order("finish")
    for one in participants.values():
        one.timing.memory = int(one.receive().header["memory"])


def end_all(participants: dict[str, Participant], watches: list[Watch], well: bool) -> None:
    """End all component processes: in order, or at once."""
    if well:
        finish(participants)
    else:
        for one in participants.values():
            with contextlib.suppress(QuintetError):
                one.line.send({"order": "abort"}, {})
    limit = time.monotonic() + (GRACE if well else 0.3)
    for watch in watches:
        watch.end(max(0.0, limit - time.monotonic()))


def free_port() -> int:
    """Return a free port of the loopback."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])
