"""Lines over zenoh: peers at an explicit endpoint, reliable, with liveliness of both sides.

The defaults of zenoh lose messages or reach too far: its congestion control drops data, its wait
before a blocked connection is closed loses messages in flight, multicast scouting connects to any
peer of the network, and a publisher's messages are lost until a subscriber is matched.
"""

import contextlib
import copy
import json
from collections.abc import Callable, Mapping
from typing import Any

import zenoh
from zenoh import handlers

from quintet.interfaces.errors import LineError
from quintet.interfaces.lines.access import common_name
from quintet.interfaces.lines.admission import ask_to_join
from quintet.interfaces.lines.endpoint import Security, check_endpoint, on_loopback
from quintet.interfaces.lines.frame_codes import CODE, DroppedFrames, FrameCodes, topic_of
from quintet.interfaces.lines.message import Frame
from quintet.interfaces.lines.reach import Obstacle, await_listener, obstacle
from quintet.interfaces.lines.transport import FramedLine, wait

DROPPED_AT_ONCE = 100  # messages that are dropped until deadlines are looked at again
CAPACITY = 1024  # messages that a receiver may leave unread; lock-step needs two or three
WAITING = 16  # batches of 64 KiB that wait to be sent: with zenoh's 4, large messages take longer
BLOCKED = 600_000_000  # us that a full connection may block before it is given up
OPEN = "open"  # the secret of lines that nobody has to be kept from
CONNECTING = 10_000  # ms
STARTING = 10.0  # s that a run may take until it listens
DOUBTFUL = 3_000  # ms, where something listens that does not answer as zenoh does
LARGEST = 1 << 30  # bytes of a message; zenoh drops larger ones without a word
LEASE = 60_000  # ms without a keep-alive; shorter ones expire while a solver uses all cores
# ms, between hosts: with this connection messages would be lost, which TCP repeats after a cut.
LEASE_BETWEEN_HOSTS = 600_000
KEEP_ALIVE = 15_000  # ms without a message until a keep-alive is sent
# ms, over TLS: zenoh does not flush, and the end of a message that the network does not take at
# once stays in the buffer of TLS until something else is sent.
KEEP_ALIVE_TLS = 100
REPLACED = "~replaced"  # in the place of a name: this process takes no part any more


def configuration(
    endpoint: str,
    listens: bool,
    security: Security | None,
    lease: int = LEASE,
    access: Mapping[str, Any] | None = None,
) -> zenoh.Config:
    """Build the settings of a session at one endpoint, and nowhere else; the lease is in ms."""
    check_endpoint(endpoint, security)
    settings: dict[str, Any] = {
        "mode": "peer",
        "scouting/multicast/enabled": False,
        "scouting/gossip/enabled": False,
        "transport/shared_memory/enabled": False,
        "transport/link/tx/lease": lease,
        "transport/link/tx/keep_alive": max(4, lease // KEEP_ALIVE),
        "transport/link/rx/max_message_size": LARGEST,
        "transport/link/tx/queue/size/data": WAITING,
        "transport/link/tx/queue/congestion_control/block/wait_before_close": BLOCKED,
        "listen/endpoints": [endpoint] if listens else [],
        "connect/endpoints": [] if listens else [endpoint],
        "connect/timeout_ms": CONNECTING,
        "connect/exit_on_failure": True,
    }
    if security is not None:
        settings["transport/link/tls"] = {
            "root_ca_certificate": security.authority,
            "enable_mtls": True,
            "verify_name_on_connect": True,
            "listen_certificate": security.certificate,
            "listen_private_key": security.key,
            "connect_certificate": security.certificate,
            "connect_private_key": security.key,
        }
        settings["transport/link/tx/keep_alive"] = max(4, lease // KEEP_ALIVE_TLS)
    if access is not None:
        settings["access_control"] = access
    config = zenoh.Config()
    for key, value in settings.items():
        config.insert_json5(key, json.dumps(value))
    return config


class Session:
    """A zenoh session and the liveliness of its peers; lines share it.

    All its keys have a verbatim part that is made of a secret: no wildcard of zenoh matches them,
    so that others can neither read nor send messages on them. With None as secret the session
    only connects, until it is given one.
    """

    def __init__(
        self,
        endpoint: str,
        listens: bool,
        me: str,
        security: Security | None,
        secret: str | None = OPEN,
        lease: int = LEASE,
        access: Mapping[str, Any] | None = None,
    ) -> None:
        self.me = me
        self._replaced: list[Any] = []  # tokens that tell former processes so; shared by `under`
        self.signs: Any = None  # a session that gives signs of life, closed with this one
        doubt = Obstacle() if listens else obstacle(endpoint, security)
        if doubt.text and doubt.certain:
            raise LineError(f"endpoint {endpoint}: {me} cannot reach it: {doubt.text}")
        config = configuration(endpoint, listens, security, lease, access)
        if doubt.text:
            config.insert_json5("connect/timeout_ms", json.dumps(DOUBTFUL))
        try:
            self.zenoh = zenoh.open(config)
        except zenoh.ZError as error:
            reason = doubt.text or _without_place(str(error))
            raise LineError(f"endpoint {endpoint}: {me} cannot reach it: {reason}") from error
        self.alive: set[str] = set()
        self.ended: set[str] = set()
        self.dropped = DroppedFrames()
        if secret is not None:
            self.enter(secret)

    def enter(self, secret: str) -> None:
        """Take part in the run with this secret, which is not sent."""
        self.secret = secret
        self.root = f"quintet/@{topic_of(secret)}"
        self._token = self.zenoh.liveliness().declare_token(f"{self.root}/alive/{self.me}")
        self._liveliness = self.zenoh.liveliness().declare_subscriber(
            f"{self.root}/alive/*", handlers.FifoChannel(CAPACITY), history=True
        )

    def under(self, secret: str) -> "Session":
        """Return this session with the keys of another secret, for one line."""
        other = copy.copy(self)
        other.alive, other.ended = set(), set()
        other.enter(secret)
        return other

    def leave(self) -> None:
        """Take no part any more under the present secret; the connection stays.

        Who is still there under this secret ends when it learns so.
        """
        token = self.zenoh.liveliness().declare_token(f"{self.root}/alive/{REPLACED}")
        self._replaced.append(token)
        self._token.undeclare()
        self._liveliness.undeclare()

    def update(self) -> None:
        """Update which peers are alive and which have ended."""
        while (sample := self._liveliness.try_recv()) is not None:
            name = str(sample.key_expr).rsplit("/", 1)[-1]
            if sample.kind == zenoh.SampleKind.DELETE:
                self.ended.add(name)
            else:
                self.alive.add(name)

    def close(self) -> None:
        """Close the session; all messages were delivered, or the run is over."""
        for session in (self.zenoh, self.signs):
            with contextlib.suppress(zenoh.ZError):
                if session:
                    session.close()


class ZenohLine(FramedLine):
    """A line between `me` and `other` over a session."""

    limit = LARGEST - (1 << 16)  # zenoh adds its own header
    room = CODE.size

    def __init__(
        self, session: Session, run: str, other: str, closes_session: bool = False
    ) -> None:
        super().__init__(run, session.me)
        self.session = session
        self.other = other
        self._closes_session = closes_session
        self._codes_in = FrameCodes(session.secret, other, session.me)
        self._codes_out = FrameCodes(session.secret, session.me, other)
        self._inbox = session.zenoh.declare_subscriber(
            f"{session.root}/{other}/to/{session.me}", handlers.FifoChannel(CAPACITY)
        )
        self._outbox = session.zenoh.declare_publisher(
            f"{session.root}/{session.me}/to/{other}",
            congestion_control=zenoh.CongestionControl.BLOCK,
            reliability=zenoh.Reliability.RELIABLE,
            priority=zenoh.Priority.DATA,
        )

    def disturb(self, outbox: Callable[[Any], Any], inbox: Callable[[Any], Any]) -> None:
        """Send and receive through others, made of zenoh's publisher and subscriber."""
        self._outbox, self._inbox = outbox(self._outbox), inbox(self._inbox)

    def wait_for_partner(self, seconds: float) -> None:
        """Wait for the other side's subscription; earlier messages would be lost."""
        outbox: Any = self._outbox  # typed as a plain bool in zenoh's stub
        wait(lambda: outbox.matching_status.matching or None, seconds, self._reason)

    def _put(self, frame: bytearray) -> None:
        self._codes_out.add(frame)
        self._publish(frame)

    def _publish(self, frame: bytearray) -> None:
        """Hand a frame and its code to zenoh."""
        try:
            self._outbox.put(frame)
        except zenoh.ZError as error:
            raise LineError(f"cannot send to {self.other}: {error}") from error

    def _poll(self) -> Frame | None:
        dropped = self.session.dropped
        for _ in range(DROPPED_AT_ONCE):
            try:
                sample = self._inbox.try_recv()
            except zenoh.ZError as error:
                raise LineError(f"the connection to {self.other} is closed: {error}") from error
            if sample is None:
                return None
            frame = self._codes_in.open(sample.payload.to_bytes(), dropped)
            if frame is not None:
                return frame
            dropped.report()
        return None

    def _broken(self) -> str:
        if not self.partner_has_left():
            return ""
        if REPLACED in self.session.alive:
            return (
                "the run has given up this process, which did not answer in time; another one "
                f"takes its place as {self.name}"
            )
        return f"{self.other} is gone"

    def partner_has_left(self) -> bool:
        """Whether the other side has ended, or is not connected any more."""
        self.session.update()
        return self.other in self.session.ended

    def leave(self) -> None:
        """Close this line, the only one of its session's secret; the connection stays."""
        self._undeclare()
        self.session.leave()

    def _undeclare(self) -> None:
        self._inbox.undeclare()
        self._outbox.undeclare()

    def close(self) -> None:
        """See `Line.close`."""
        if self._closes_session:
            self.session.close()


def connect(
    endpoint: str, name: str, security: Security | None = None, secret: str = OPEN
) -> ZenohLine:
    """Open the line of a component that the coupler has started."""
    return _to_coupler(Session(endpoint, False, name, security, secret))


def join(
    endpoint: str,
    name: str,
    about: Mapping[str, Any],
    security: Security | None = None,
    say: Callable[[str], object] = lambda text: None,
) -> ZenohLine:
    """Open the line of a component that was started by hand: the coupler may refuse it.

    It may be started a little before the run.
    """
    await_listener(endpoint, STARTING, say)
    lease = LEASE if on_loopback(endpoint) else LEASE_BETWEEN_HOSTS
    session = Session(endpoint, False, name, security, None, lease)
    try:
        certificate = common_name(security.certificate) if security else ""
        session.enter(ask_to_join(session.zenoh, endpoint, name, about, certificate))
    except BaseException:
        session.close()
        raise
    return _to_coupler(session)


def _to_coupler(session: Session) -> ZenohLine:
    line = ZenohLine(session, "", "coupler", closes_session=True)
    line.answers_again = True
    line.wait_for_partner(30.0)
    return line


def _without_place(text: str) -> str:
    """What zenoh says of an error, without the place in its own code."""
    return text.partition(" at /")[0]
