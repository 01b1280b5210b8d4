"""Who may join a run by hand, and messages from outside the run, which are counted and dropped.

The messages of a run travel on keys with a secret, verbatim part (``@...``), which no wildcard of
zenoh matches: whoever does not know it can neither read nor send them. A component that the run
starts gets the secret in its environment. One that is started by hand asks for it, and gets it
once for each awaited name. This keeps other programs and mistakes out; it is no authentication.
"""

import json
import threading
import time
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from typing import Any

from quintet.interfaces.errors import LineError

JOIN = "quintet/join"
OUTSIDE = "quintet/**"  # all keys of quintet but those with a secret part
ANSWERING = 5.0  # s for the coupler to answer who asks to join
LONGEST_REQUEST = 4096  # bytes
TOO_MANY = 1000  # messages between two looks, after which nobody listens to more for a while
DEAF = 5.0  # s
REPEATED = 10.0  # s between two reports


@dataclass
class ForeignMessages:
    """Messages and requests that came from outside a run.

    Their contents are not kept. Where too many come, the subscription is given up for a while:
    zenoh drops them then without work for this process.
    """

    session: Any
    count: int = 0
    refused: int = 0  # requests to join
    first: str = ""  # of the messages
    reason: str = ""  # why the last request to join was refused
    at_least: bool = False
    _lock: threading.Lock = field(default_factory=threading.Lock)
    _subscription: Any = None
    _reported: int = 0
    _report_at: float = 0.0
    _listen_at: float = 0.0

    def look(self) -> str:
        """Return what the user should know now; called many times a second."""
        # Imported by runs over zenoh only.
        from zenoh import handlers

        now = time.monotonic()
        if self._subscription is None:
            if now >= self._listen_at:
                # Not a function: its thread would still run as Python ends, and abort the process.
                self._subscription = self.session.declare_subscriber(
                    OUTSIDE, handlers.RingChannel(TOO_MANY + 1)
                )
        elif self._count_new() > TOO_MANY:
            self._subscription.undeclare()
            self._subscription, self._listen_at = None, now + DEAF
            self.at_least = True
        if self.count + self.refused == self._reported or now < self._report_at:
            return ""
        self._reported, self._report_at = self.count + self.refused, now + REPEATED
        return "; ".join(self.summary())

    def summary(self) -> list[str]:
        """What came so far, in sentences."""
        said = []
        if self.count:
            number = f"{'at least ' * self.at_least}{self.count}"
            said.append(
                f"{number} message(s) from outside the run were dropped; the first: {self.first}. "
                "The run is not affected. End the program that sends them, or use another endpoint."
            )
        if self.refused:
            said.append(f"{self.refused} request(s) to join were refused; the last: {self.reason}")
        return said

    def _count_new(self) -> int:
        """Count what came since the last look, up to `TOO_MANY` + 1."""
        number = 0
        while number <= TOO_MANY and (sample := self._subscription.try_recv()) is not None:
            if not self.first:
                size = len(sample.payload.to_bytes())
                self.first = f"{size} bytes to {_printable(str(sample.key_expr))}"
            number += 1
        self.count += number
        return number

    def refuse(self, reason: str) -> str:
        """Count a request to join that is refused."""
        with self._lock:
            self.refused += 1
            self.reason = reason
        return reason


class Admission:
    """Answers who asks to join by hand: the secret of the run, or why it is refused.

    Parameters
    ----------
    awaited : mapping
        Kind of every component that is to join by hand, by its name.
    others : collection
        Names of the components that the run itself starts.
    """

    def __init__(
        self,
        session: Any,
        secret: str,
        awaited: Mapping[str, str],
        others: Collection[str],
        foreign: ForeignMessages,
    ) -> None:
        self.awaited, self.others, self.foreign = awaited, others, foreign
        self.joined: dict[str, str] = {}  # who, by name
        self._secrets = dict.fromkeys(awaited, secret)
        self._lock = threading.Lock()
        self._requests = session.declare_queryable(f"{JOIN}/*", self._answer)

    def _answer(self, query: Any) -> None:
        key = str(query.key_expr)
        name = key.removeprefix(f"{JOIN}/")
        payload = query.payload.to_bytes() if query.payload is not None else b""
        with self._lock:
            refusal, secret = self.refusal(name, payload), self._secrets.get(name, "")
        if refusal:
            query.reply_err(self.foreign.refuse(refusal).encode())
        else:
            query.reply(key, secret.encode())

    def await_join(self, name: str, secret: str) -> None:
        """Let somebody join under a name, whoever did before; hand out this secret."""
        with self._lock:
            self.joined.pop(name, None)
            self._secrets[name] = secret

    def refusal(self, name: str, request: bytes) -> str:
        """Why a component may not join; "" where it may, and from then on nobody else."""
        asking = _request(request)
        if asking is None:
            return "a request to join must name its kind, host and process; it does not."
        if name in self.others:
            return (
                f"{name} is started by the run itself. Start the run with --elsewhere {name} to "
                "join it by hand."
            )
        if name not in self.awaited:
            awaited = ", ".join(sorted(self.awaited)) or "nobody"
            return f"the run awaits {awaited}, not {_printable(name)}."
        kind, who = asking
        if kind != self.awaited[name]:
            return (
                f"{name} must be of kind {self.awaited[name]}; found {kind}. Use the scene of the "
                "run."
            )
        if name in self.joined:
            return f"{name} has joined already ({self.joined[name]}). End the second one."
        self.joined[name] = who
        return ""


def _request(request: bytes) -> tuple[str, str] | None:
    """Kind of a component that asks to join, and which process it is."""
    if len(request) > LONGEST_REQUEST:
        return None
    try:
        asking = json.loads(request)
        kind, host, pid = asking["kind"], asking["host"], asking["pid"]
    except (ValueError, TypeError, LookupError, RecursionError):
        return None
    if not (isinstance(kind, str) and isinstance(host, str) and type(pid) is int):
        return None
    return _printable(kind), f"process {pid} on {_printable(host)}"


def _printable(text: str) -> str:
    """A text from outside, short and without what a terminal or an encoding takes for its own."""
    return "".join(sign if sign.isprintable() else "?" for sign in text[:80])


def ask_to_join(session: Any, name: str, about: Mapping[str, Any]) -> str:
    """Ask the coupler for the secret of its run; raise what it answers otherwise."""
    asking = json.dumps({key: about[key] for key in ("kind", "host", "pid")})
    for reply in session.get(f"{JOIN}/{name}", payload=asking.encode(), timeout=ANSWERING):
        if reply.ok is not None:
            return str(reply.ok.payload.to_bytes().decode())
        raise LineError(f"the run refuses it: {reply.err.payload.to_bytes().decode()}")
    raise LineError(
        f"no run answered within {ANSWERING:g} s. Give the endpoint that the run prints."
    )
