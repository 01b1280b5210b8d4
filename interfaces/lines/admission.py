"""Who may join a run by hand.

The messages of a component travel on keys with a verbatim part (``@...``) that is made of a secret,
and have codes (`frame_codes`). A component that the run starts gets the secret in its environment.
One that is started by hand asks to join, once for each awaited name: over TLS with a certificate of
its name, over plain tcp with a proof that it can read the file of the secret.
"""

import json
import threading
import time
from collections.abc import Collection, Mapping
from typing import Any, NamedTuple

from quintet.interfaces.errors import LineError
from quintet.interfaces.lines import join_secret
from quintet.interfaces.lines.access import ADMIT, JOIN
from quintet.interfaces.lines.foreign_messages import ForeignMessages, printable

ANSWERING = 5.0  # s for the coupler to answer who asks to join
AGAIN = 0.1  # s until a request is repeated that nobody has answered
LONGEST_REQUEST = 4096  # bytes


class Admission:
    """Answers who asks to join by hand: that it may, or why it is refused.

    Parameters
    ----------
    awaited : mapping
        Kind of every component that is to join by hand, by its name.
    others : collection
        Names of the components that the run itself starts.
    endpoint : str
        Where the coupler listens. Over TLS the secret is in the answer, else in a file.
    """

    def __init__(
        self,
        session: Any,
        awaited: Mapping[str, str],
        others: Collection[str],
        foreign: ForeignMessages,
        endpoint: str,
    ) -> None:
        self.awaited, self.others, self.foreign = awaited, others, foreign
        self.endpoint, self.secured = endpoint, endpoint.startswith("tls/")
        self.joined: dict[str, str] = {}  # who, by name
        self._secrets: dict[str, str] = {}
        self._lock = threading.Lock()
        self._opened = threading.Event()
        self._requests = [session.declare_queryable(f"{JOIN}/*", self._answer)]
        if self.secured:
            keys = [f"{ADMIT}/{name}" for name in awaited]
            self._requests += [session.declare_queryable(key, self._answer) for key in keys]

    def open(self) -> None:
        """Begin to answer; who has asked before is waiting."""
        self._opened.set()

    def _answer(self, query: Any) -> None:
        key = str(query.key_expr)
        payload = query.payload.to_bytes() if query.payload is not None else b""
        admits = self.secured and key.startswith(f"{ADMIT}/")
        name = key.removeprefix(f"{ADMIT if admits else JOIN}/")
        self._opened.wait(ANSWERING)
        with self._lock:
            refusal, secret = self.refusal(name, payload, admits), self._secrets.get(name, "")
        if refusal:
            query.reply_err(self.foreign.refuse(refusal).encode())
        else:
            query.reply(key, secret.encode() if admits else b"")

    def await_join(self, name: str, secret: str) -> None:
        """Let somebody join under a name, whoever did before, with this secret."""
        if not self.secured:
            join_secret.write(self.endpoint, name, secret)
        with self._lock:
            self.joined.pop(name, None)
            self._secrets[name] = secret

    def refusal(self, name: str, request: bytes, certified: bool) -> str:
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
            return f"the run awaits {awaited}, not {printable(name)}."
        if asking.kind != self.awaited[name]:
            return (
                f"{name} must be of kind {self.awaited[name]}; found {asking.kind}. Use the scene "
                "of the run."
            )
        if refusal := self._unproven(name, asking, certified):
            return refusal
        if name in self.joined:
            return f"{name} has joined already ({self.joined[name]}). End the second one."
        self.joined[name] = asking.who
        return ""

    def _unproven(self, name: str, asking: "Request", certified: bool) -> str:
        """Why it is not known that a request comes from the component that it names."""
        if self.secured and not certified:
            return (
                f"{name} must join with a certificate whose common name is {name}; that of "
                f"{asking.who} has {asking.certificate}. Name its certificate with --tls."
            )
        secret = self._secrets.get(name, "")
        if self.secured or join_secret.proves(asking.proof, secret, name, asking.text):
            return ""
        return (
            f"over plain tcp {name} must be started by the user who started the run, on the same "
            f"host: it must know the secret in {join_secret.path_of(self.endpoint, name)}; "
            f"{asking.who} does not. Join as this user, or use an endpoint with tls."
        )


class Request(NamedTuple):
    """A request to join, made printable."""

    kind: str
    who: str
    certificate: str  # common name, as the sender says
    proof: object
    text: str  # to which the proof belongs


def _request(request: bytes) -> Request | None:
    """Read a request to join."""
    if len(request) > LONGEST_REQUEST:
        return None
    try:
        asking = json.loads(request)
        kind, host, pid = asking["kind"], asking["host"], asking["pid"]
    except (ValueError, TypeError, LookupError, RecursionError):
        return None
    if not (isinstance(kind, str) and isinstance(host, str) and type(pid) is int):
        return None
    who = f"process {pid} on {printable(host)}"
    certificate = printable(str(asking.get("certificate", "none")))
    text = _proven_text(asking)
    return Request(printable(kind), who, certificate, asking.get("proof"), text)


def _proven_text(asking: Mapping[str, Any]) -> str:
    return json.dumps([asking["kind"], asking["host"], asking["pid"]])


def ask_to_join(
    session: Any, endpoint: str, name: str, about: Mapping[str, Any], certificate: str = ""
) -> str:
    """Ask the coupler to join; return the secret of the line, or raise what it answers.

    `certificate` is the common name of that with which the session connects, over TLS.
    """
    asking: dict[str, Any] = {key: about[key] for key in ("kind", "host", "pid")}
    keys, secret = [f"{JOIN}/{name}"], ""
    if certificate:
        asking["certificate"] = certificate
        keys.insert(0, f"{ADMIT}/{name}")  # where only a certificate of this name is heard
    elif secret := join_secret.read(endpoint, name):
        asking["proof"] = join_secret.proof(secret, name, _proven_text(asking))
    payload = json.dumps(asking).encode()
    limit = time.monotonic() + ANSWERING
    while time.monotonic() < limit:
        for key in keys:
            for reply in session.get(key, payload=payload, timeout=ANSWERING):
                if reply.ok is not None:
                    return secret or str(reply.ok.payload.to_bytes().decode())
                refusal = reply.err.payload.to_bytes().decode()
                raise LineError(f"the run refuses it: {refusal}")
        time.sleep(AGAIN)
    raise LineError(
        f"no run answered within {ANSWERING:g} s. Give the endpoint that the run prints."
    )
