"""Components as processes that zenoh joins to the coupler, started here or by hand."""

import contextlib
import secrets
import shlex
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

from quintet.coupler.coupling.participant import LONGEST_WAIT, Participant, finish_all
from quintet.coupler.launch.acceptance import accept, identify, log_of, probe_of
from quintet.coupler.launch.component_process import ComponentProcess
from quintet.coupler.launch.disturbance import UNDISTURBED, Disturbance
from quintet.coupler.launch.mpi_job import exit_files, find_launcher, under_shell
from quintet.coupler.launch.process_probe import ProcessProbe
from quintet.coupler.launch.processes import GRACE, RUN, end_marked, start
from quintet.coupler.launch.restarts import Restarts
from quintet.coupler.launch.watchdog import Watchdog
from quintet.coupler.scene.overrides import run_arguments
from quintet.coupler.scene.read import library
from quintet.coupler.scene.scene import Scene
from quintet.interfaces.errors import LineError, QuintetError, SceneError
from quintet.interfaces.lines import join_secret
from quintet.interfaces.lines.access import access, common_name
from quintet.interfaces.lines.admission import Admission
from quintet.interfaces.lines.endpoint import Security, free_port, on_loopback
from quintet.interfaces.lines.foreign_messages import ForeignMessages
from quintet.interfaces.lines.frame_codes import topic_of
from quintet.interfaces.lines.transport import REPEAT, WatchedLine
from quintet.interfaces.lines.zenoh import LEASE, LEASE_BETWEEN_HOSTS, Session, ZenohLine

JOINING_BY_HAND = 3600.0  # s until a component says hello that somebody starts elsewhere
PORTS_TRIED = 5  # of those that are free when they are looked for, and may be taken meanwhile
ABORTING = 0.2  # s for components to end by themselves when a run fails


class OverZenoh:
    """One process per component, started here or joined by hand."""

    def __init__(
        self, scene: Scene, folder: Path, watchdog: Watchdog, disturbance: Disturbance = UNDISTURBED
    ) -> None:
        self.scene, self.folder, self.watchdog = scene, folder, watchdog
        self.disturbance = disturbance
        self.endpoint = scene.endpoint or f"tcp/127.0.0.1:{free_port()}"
        self.participants: dict[str, Participant] = {}
        self.probes: dict[str, ProcessProbe] = {}
        # Each process of a component has a secret of its own, for a line of its own.
        self.secrets = {
            name: [secrets.token_hex(16) for _ in range(1 + scene.file.restarts)]
            for name in scene.components
        }
        self.several_hosts = bool(scene.elsewhere) and not on_loopback(self.endpoint)
        self.session = self._listen_somewhere()
        self.foreign = ForeignMessages(self.session.zenoh, self.session.dropped)
        kinds = {name: plan.manifest.kind for name, plan in scene.components.items()}
        awaited = {name: kind for name, kind in kinds.items() if name in scene.elsewhere}
        others = kinds.keys() - awaited.keys()
        self.admission = Admission(self.session.zenoh, awaited, others, self.foreign, self.endpoint)
        watchdog.news = self.foreign.look
        self.run = watchdog.mark
        try:
            if scene.security and kinds.keys() - awaited.keys():
                require_reachable(self.endpoint, scene.security)
            waits = {name: self._join(name) for name in scene.components}
            self.admission.open()  # not before, or who joins early gets a secret of nobody
            for name, wait_for_partner in waits.items():
                seconds = JOINING_BY_HAND if name in scene.elsewhere else LONGEST_WAIT
                hello = self.participants[name].await_hello(seconds, wait_for_partner)
                accept(scene, self.participants[name], hello, self.probes[name], folder, 0)
        except BaseException:
            self.close(False)
            raise

    def _listen_somewhere(self) -> Session:
        """Open the session; where no endpoint is given, at another port if one is taken by now."""
        for number in range(1, 1 + PORTS_TRIED):
            try:
                return self._listen()
            except LineError as error:
                if self.scene.endpoint or number == PORTS_TRIED:
                    remedy = "Name another endpoint, or give none."
                    raise SceneError(f"scene.{error}. {remedy}") from error
                join_secret.remove(self.endpoint, self.scene.elsewhere)
                self.endpoint = f"tcp/127.0.0.1:{free_port()}"
        raise AssertionError

    def _listen(self) -> Session:
        """Open the session; over TLS each certificate has the rights of its common name."""
        rights = None
        if self.scene.security:
            topics = {name: map(topic_of, parts) for name, parts in self.secrets.items()}
            rights = access(common_name(self.scene.security.certificate), topics)
        elif self.scene.elsewhere:
            for name in self.scene.elsewhere:  # before anybody can ask
                join_secret.write(self.endpoint, name, self.secrets[name][0])
        lease = LEASE_BETWEEN_HOSTS if self.several_hosts else LEASE
        return Session(self.endpoint, True, "coupler", self.scene.security, None, lease, rights)

    def _join(self, name: str) -> Callable[[float], None]:
        """Start a component, or await it; return what waits until it is connected."""
        restarts = Restarts(self.scene.file.restarts)
        if restarts.limit:
            return self._join_restartable(name, restarts)
        line = self._begin_process(name).line
        self._watch(self._participant(name, line), restarts)
        return line.wait_for_partner

    def _join_restartable(self, name: str, restarts: Restarts) -> Callable[[float], None]:
        """Do so with a component that is started again if its process dies."""
        # Only runs that restart components keep their orders.
        from quintet.coupler.launch.restartable_line import RestartableLine

        check_hello = partial(identify, self.scene, name, folder=self.folder, first=0)
        line = RestartableLine(
            name, restarts, partial(self._begin_process, name), check_hello, self.folder
        )
        participant = self._participant(name, line)
        line.on_replay, line.on_return = participant.wait_for_replay, participant.notes.append
        self._watch(participant, restarts)
        return line.wait_for_partner

    def _participant(self, name: str, line: WatchedLine) -> Participant:
        line = self.disturbance.line(name, line, lambda: self.probes[name].pids())
        return Participant(name, line)

    def _watch(self, participant: Participant, restarts: Restarts) -> None:
        name = participant.name
        self.participants[name] = participant
        self.watchdog.add(participant, self.probes[name], self.scene.patience(name), restarts)

    def _begin_process(self, name: str) -> ComponentProcess:
        """Begin with a secret of its own, so that nobody hears the process that was before."""
        secret = self.secrets[name].pop(0)
        if name in self.scene.elsewhere:
            self.admission.await_join(name, secret)
        process = self._begin(name, self.session.under(secret), secret)
        self.watchdog.watch_instead(name, process.probe)
        return process

    def _begin(self, name: str, session: Session, secret: str) -> ComponentProcess:
        """Start a process of a component, or await it, with a line to it."""
        awaited, mark = name in self.scene.elsewhere, secrets.token_hex(8)
        probe = self.probes[name] = probe_of(self.scene, name, awaited=awaited)
        line = self._open_line(name, session, probe)
        if self.scene.file.restarts:
            line.repeat_after = REPEAT
        self.disturbance.wire(name, line)
        if awaited:
            command = join_command(self.scene, name, self.endpoint)
            print(f"{name} is awaited: {command}", flush=True)
            return ComponentProcess(line, probe, self.scene.patience(name), mark)
        self._start(name, probe, secret, mark)
        return ComponentProcess(line, probe, LONGEST_WAIT, mark)

    def _open_line(self, name: str, session: Session, probe: ProcessProbe) -> ZenohLine:
        if not (probe.by_hand and self.several_hosts):
            return ZenohLine(session, self.run, name)
        # Only runs with components on other hosts watch these.
        from quintet.coupler.launch.remote_host import RemoteHost, line_to

        line = line_to(session, self.run, name)
        probe.host = RemoteHost(session, line)
        return line

    def _start(self, name: str, probe: ProcessProbe, secret: str, mark: str) -> None:
        scene, folder = self.scene, self.folder
        plan, log = scene.components[name], log_of(folder, name)
        arguments = [
            "-m",
            "quintet.interfaces.serving.process",
            plan.kind,
            "--name",
            name,
            "--at",
            self.endpoint,
        ]
        if scene.tls:
            arguments += ["--tls", *scene.tls]
        for place in scene.import_folders:
            arguments += ["--look-in", place]
        launcher: list[str] = []
        if plan.ranks > 1:
            for path in exit_files(folder, name, plan.ranks, 0):
                path.unlink(missing_ok=True)  # of ranks that were before
            arguments = ["-m", "mpi4py", *arguments, "--ranks", str(plan.ranks)]
            arguments += ["--log", str(log)]
            launcher = [*find_launcher(), "-n", str(plan.ranks)]
            launcher += under_shell(folder, name, plan.ranks)
        process = start(arguments, log, plan.threads, self.run, secret, launcher, mark)
        probe.pid, probe.process = process.pid, process

    def close(self, well: bool) -> None:
        """See `Connection.close`."""
        self.watchdog.expect_ends()
        end_all(self.participants, self.probes, well, self.watchdog)
        self.watchdog.close()
        self.watchdog.news = lambda: ""
        end_marked(RUN, self.run)
        for participant in self.participants.values():
            participant.line.close()
        if self.several_hosts:
            # Only runs with components on other hosts need it.
            from quintet.coupler.launch.remote_host import close_within

            close_within(self.session)
        else:
            self.session.close()
        if not self.scene.security:
            join_secret.remove(self.endpoint, self.scene.elsewhere)

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
    files = own_certificate(scene, name) if scene.tls else []
    return shlex.join(["quintet", "join", *asked, name, "--at", endpoint, *files])


def own_certificate(scene: Scene, name: str) -> list[str]:
    """Options for the certificate of a component, if it lies beside that of the coupler."""
    # Only runs over TLS look for it.
    from quintet.coupler.launch.certificates import files_of

    files = files_of(Path(scene.tls[1]).parent, name)
    return ["--tls", *files] if all(Path(file).is_file() for file in files) else []


def end_all(
    participants: dict[str, Participant], probes: dict[str, ProcessProbe], well: bool, dog: Watchdog
) -> None:
    """End all component processes: in order, or at once."""
    if well:
        finish_all(participants)
    elif dog.verdict:  # some may not listen any more
        for probe in probes.values():
            probe.kill()
    else:
        for participant in participants.values():
            with contextlib.suppress(QuintetError):
                participant.line.send({"order": "abort"}, {})
    limit = time.monotonic() + (GRACE if well and not dog.stop() else ABORTING)
    for probe in probes.values():
        probe.end(max(0.0, limit - time.monotonic()))
