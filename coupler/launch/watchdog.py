"""The watchdog of a run: a thread that sees who died and who keeps the others waiting.

It decides; the thread that couples carries it out when it next looks, or is made to look. What
a component may take is never known, so that a false alarm is worse than a late component: nobody is
ended who compiles kernels, or who has not kept the others waiting for its patience beyond three of
its usual windows. A component that is built may compute for thirty times its patience, and may do
nothing for its patience; it is reported once it has computed for its patience, or done nothing for
some seconds. A stopped process is ended at once: nothing goes on by itself there.
"""

import contextlib
import math
import secrets
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import Protocol

from quintet.coupler.coupling.participant import ComponentFailed, Participant
from quintet.coupler.launch import stack
from quintet.coupler.launch.process_probe import IDLE, ProcessProbe
from quintet.coupler.launch.restarts import Restarts

INTERVAL = 0.05  # s between two rounds of all components
LONGEST_ROUND = 1.0  # s; if more has passed, this process itself was stopped meanwhile
USUAL, EXTRA = 3.0, 5.0  # reported after 3 usual windows and 5 s
IDLE_FOR = 4.0  # s of doing nothing, while it is built, after which it is reported
DEAD = 0.3  # s until a death is reported; before, whoever waits for the component knows more
ENDING, SAVING = 0.7, 1.1  # s to end a window, and to save, after an end was asked for
OBEYING, AT_ONCE = 0.5, 0.15  # s for the thread that couples to carry out a verdict
TURN = 1e-4  # s that this thread waits for the interpreter's lock while it looks
BUILDING = 30.0  # times its patience may a component compute while it is built
POKE = signal.SIGURG  # makes the main thread look; without a handler it does nothing


class Request(Protocol):
    """Whether a run is asked to end."""

    def __call__(self) -> bool:
        """Return whether to end."""

    def at_once(self) -> bool:
        """Return whether to end without waiting for anything."""

    @property
    def leave(self) -> Callable[[], None] | None:
        """Ends this process, with all that is left to do; None where it may not be ended."""


class Substitute(Protocol):
    """Watches in this watchdog's place when no Python runs in its process."""

    def follow(self, participant: Participant) -> None:
        """Note when the coupler waits for a component."""

    def note_round(self, participants: Iterable[Participant]) -> None:
        """Note that this watchdog is at work."""


@dataclass(slots=True)
class Watched:
    """One component, and for how long it has kept the others waiting."""

    participant: Participant
    probe: ProcessProbe
    patience: float  # s
    restarts: Restarts = field(default_factory=Restarts)
    since: float = 0.0  # when the wait began, as the participant has it
    waited: float = 0.0  # s
    idle: float = 0.0  # s in a row that its process did nothing while it was to be built
    tell_at: float = 0.0  # s of waiting
    end_at: float = 0.0  # s of waiting
    reported: bool = False
    dead_since: float = 0.0
    may_end: bool = False  # it was told to finish

    def begin(self, since: float) -> None:
        """Begin a new wait."""
        self.since, self.waited, self.idle, self.reported = since, 0.0, 0.0, False
        self.probe.begin()
        usual = USUAL * self.participant.timing.usual
        if self.participant.built:
            silence = self.probe.host.noticed_within if self.probe.host else 0.0
            self.end_at = usual + max(self.patience, silence)
            self.tell_at = min(usual + EXTRA, self.end_at)
        else:
            begun = self.probe.pid or self.participant.order  # else it is awaited from elsewhere
            self.end_at = BUILDING * self.patience if begun else math.inf
            self.tell_at = self.patience

    def read(self, passed: float) -> None:
        """Find out what its process does, now and then; add to the time in which it is idle."""
        built = self.participant.built
        if not built or self.waited > 0.2 * self.tell_at:
            self.probe.read()
        self.idle = self.idle + passed if not built and self.probe.activity == IDLE else 0.0

    def is_late(self) -> bool:
        """Whether the user should know of it now."""
        stuck = self.idle > IDLE_FOR and not self.reported
        return stuck or self.waited > self.tell_at or self.is_over()

    def is_over(self) -> bool:
        """Whether it has taken longer than it may."""
        return self.waited > self.end_at or self.idle > self.patience


@dataclass(slots=True)
class Watchdog:
    """Watches all components of a run while they are joined to the coupler.

    Parameters
    ----------
    stop : Request
        Asks for the end of the run.
    in_main_thread : bool
        Whether components run in the main thread of this process.
    acts : function
        Whether it is this watchdog's turn to tell and to end.
    alone : bool
        Whether the run has one component, which keeps nobody waiting.
    grace : float, s
        More time than usual for the end of a window and for a snapshot, after an end was asked for.
    """

    stop: Request
    in_main_thread: bool = False
    acts: Callable[[], bool] = lambda: True
    alone: bool = False
    grace: float = 0.0
    substitute: Substitute | None = None
    mark: str = field(default_factory=lambda: secrets.token_hex(8))  # of all processes of the run
    news: Callable[[], str] = lambda: ""  # what else the user should know, in every round
    verdict: BaseException | None = None  # why the run is to end
    _all: dict[str, Watched] = field(default_factory=dict)
    _asked_at: float = 0.0
    _judged_at: float = 0.0
    _peeked_at: float = 0.0
    _last: float = 0.0
    _closed: threading.Event = field(default_factory=threading.Event)
    _thread: threading.Thread | None = None

    def add(
        self,
        participant: Participant,
        probe: ProcessProbe,
        patience: float,
        restarts: Restarts | None = None,
    ) -> None:
        """Watch a component too; its death ends the run where no restarts are left."""
        component = Watched(participant, probe, patience, restarts or Restarts())
        self._all[participant.name] = component
        participant.verdict = lambda: self.verdict
        participant.line.watch = lambda: self.check(component)
        if self.substitute:
            self.substitute.follow(participant)
        if self._thread is None:
            self._last = time.monotonic()
            self._thread = threading.Thread(target=self._run, name="watchdog", daemon=True)
            self._thread.start()

    def watch_instead(self, name: str, probe: ProcessProbe) -> None:
        """Watch another process of a component, if it is watched."""
        if component := self._all.get(name):
            component.probe, component.dead_since = probe, 0.0

    def check(self, awaited: Watched) -> str:
        """Say why an answer will not come; raise what ends the run. For the thread that couples."""
        if self.verdict:
            raise self.verdict
        now = time.monotonic()
        if now - self._peeked_at > 2 * INTERVAL:
            self._peeked_at = now + LONGEST_ROUND  # what is received now comes here too
            for component in self._all.values():
                if component is not awaited and component.participant.has_failed():
                    component.participant.receive()  # raises its failure
            self._peeked_at = now
        if awaited.probe.alive():
            return ""
        ending = awaited.probe.ending()
        first = self._first_dead(awaited)
        if first is not awaited and not awaited.restarts.left:
            self.fail(first, first.probe.ending())
            if self.verdict:
                raise self.verdict
        return ending

    def _first_dead(self, component: Watched) -> Watched:
        """Which died first, of a dead component and others: an MPI job ends all with one."""
        every = self._all.values()
        dead = [each for each in every if not (each.may_end or each.probe.alive())]
        return min([component, *dead], key=lambda each: each.probe.ended_at())

    def expect_ends(self) -> None:
        """From now on components may end."""
        for component in self._all.values():
            component.may_end = True

    def close(self) -> None:
        """Watch no more."""
        self._closed.set()
        if self._thread and self._thread is not threading.current_thread():
            self._thread.join(1.0)

    def _run(self) -> None:
        while not self._closed.wait(INTERVAL):
            now = time.monotonic()
            passed, self._last = min(now - self._last, LONGEST_ROUND), now
            if self.substitute:
                self.substitute.note_round(
                    [component.participant for component in list(self._all.values())]
                )
            if news := self.news():
                say(news)
            if self.verdict:
                self._enforce(now)
                continue
            self._check_stop(now)
            for component in list(self._all.values()):
                self._check_death(component, now)
                if not self._check_host(component):
                    self.check_wait(component, passed)

    def _check_stop(self, now: float) -> None:
        if not self.stop():
            return
        self._asked_at = self._asked_at or now
        waited = [
            component.participant
            for component in self._all.values()
            if component.participant.keeping_others_waiting.since
        ]
        saves = any(component.order in ("save", "finish") for component in waited)
        limit = self.grace + (SAVING if saves else ENDING)
        late = bool(waited) and now - self._asked_at > limit
        if late or self.stop.at_once():
            self._judge(KeyboardInterrupt())

    def _check_death(self, component: Watched, now: float) -> None:
        if component.may_end or component.probe.alive():
            return
        if component.restarts.left:  # its line sees to that
            return
        component.dead_since = component.dead_since or now
        if now - component.dead_since > DEAD:
            first = self._first_dead(component)
            joined = "" if first.participant.order else "did not join: "
            ending = first.probe.ending() + first.restarts.remark()
            self.fail(first, joined + ending)

    def _check_host(self, component: Watched) -> bool:
        """Tell whether the host of a component is silent; give it up when that takes too long."""
        host = component.probe.host
        if host is None or component.probe.given_up:
            return False
        if news := host.look(component.patience):
            say(f"{component.participant.name}: {news}")
            component.begin(component.since)  # when the host is back, its patience begins again
        if host.silent > host.noticed_within + component.patience:
            self.fail(component, f"host {host.name} does not answer: {host.silence_text()}")
        return host.silent > 0.0

    def check_wait(self, component: Watched, passed: float) -> None:
        """Tell of a component that keeps the others waiting; end it if that takes too long."""
        participant, probe = component.participant, component.probe
        since = participant.keeping_others_waiting.since
        if since != component.since:
            if component.reported:
                say(f"{participant.name} goes on after {component.waited:.1f} s")
            component.begin(since)
            passed = min(passed, time.monotonic() - since)
        if not since:
            return
        component.waited += passed
        if not self.in_main_thread and probe.stopped():
            probe.activity = "stopped"
            self.fail(component, f"stopped responding: {probe.described()}")
            return
        with short_turns() if self.in_main_thread else contextlib.nullcontext():
            component.read(passed)
            if component.is_late() and self.acts():
                self._tell_or_end(component)

    def _tell_or_end(self, component: Watched) -> None:
        calls = component.probe.where()
        component.probe.leave_out()
        if component.participant.keeping_others_waiting.since != component.since:
            return  # it has answered
        participant, doing = component.participant, component.probe.described()
        place = participant.window
        if stack.compiles(calls):
            doing = doing.replace("computing", "compiling")
        duration = f"{component.waited:.1f} s " + (
            f"in window {place}" if participant.built else "to be built"
        )
        if component.probe.awaited:
            component.reported, component.tell_at = True, 2.0 * component.waited
            say(f"the run waits for {participant.name}: {doing}")
            return
        usual = f", usually {participant.timing.usual:.2g} s" if participant.timing.usual else ""
        where = stack.innermost(calls)
        over = component.is_over()
        if over and not stack.compiles(calls):
            at = f", at {where[0].removeprefix('  File ')}" if where else ""
            cause = (
                f"stopped responding: kept the others waiting for {duration}{usual}; {doing}{at}"
            )
            self.fail(component, cause, calls)
            return
        if over:
            component.end_at, component.idle = component.end_at + component.patience, 0.0
        component.reported, component.tell_at = True, 2.0 * component.waited
        wait = "has taken" if self.alone else "keeps the others waiting for"
        where = [] if stack.compiles(calls) else where  # calls of the compiler say nothing
        say(f"{participant.name} {wait} {duration}{usual}: {doing}", where)

    def fail(self, component: Watched, cause: str, calls: str = "") -> None:
        """Decide that the run ends, as a component has failed, or that its process does."""
        participant = component.participant
        probe = component.probe
        if component.restarts.left and (probe.process or probe.by_hand):  # another can take over
            if probe.alive():
                if probe.pids():
                    say(f"{participant.name} {cause}")
                probe.give_up(cause)
            return
        self._judge(ComponentFailed(participant.name, participant.window, cause, calls))

    def _judge(self, verdict: BaseException) -> None:
        """Decide that the run ends."""
        if self.verdict is None:
            self.verdict, self._judged_at = verdict, self._last
            self._poke()

    def _enforce(self, now: float) -> None:
        """Make the thread that couples carry out the verdict, or do without it."""
        if now - self._judged_at < (AT_ONCE if self.stop.at_once() else OBEYING):
            return
        self._judged_at = now
        self._poke()
        if not self.in_main_thread:
            for component in self._all.values():
                component.probe.kill()
        elif self.stop.at_once() or isinstance(self.verdict, ComponentFailed):
            if self.stop.leave:
                self.stop.leave()

    def _poke(self) -> None:
        ident = threading.main_thread().ident
        if self.in_main_thread and ident and signal.getsignal(POKE) is not signal.SIG_DFL:
            signal.pthread_kill(ident, POKE)


@contextlib.contextmanager
def short_turns() -> Iterator[None]:
    """Look at files without long waits for the interpreter's lock.

    Each of hundreds of looks gives the lock up. A solver in Python, in the main thread, takes it
    and keeps it for the interpreter's switch interval, 5 ms: a round took seconds.
    """
    before = sys.getswitchinterval()
    sys.setswitchinterval(min(TURN, before))
    try:
        yield
    finally:
        sys.setswitchinterval(before)


def say(text: str, lines: list[str] | None = None) -> None:
    """Print what the user should know now."""
    print("\n".join([f"\nquintet: {text}", *(lines or [])]), file=sys.stderr, flush=True)
