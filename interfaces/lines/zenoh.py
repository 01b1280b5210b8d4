"""Lines over zenoh: peers at an explicit endpoint, nothing dropped, death noticed at once.

Every setting here answers a measured trap: the default congestion control drops data, the
default wait before a blocked connection is closed loses what was in flight, discovery by
multicast joins strangers, and a publisher sends into the void until it is matched.
"""

import contextlib
import json
from typing import Any

import zenoh
from zenoh import handlers

from quintet.interfaces.errors import LineError
from quintet.interfaces.lines.endpoint import Security, check_endpoint
from quintet.interfaces.lines.message import Frame
from quintet.interfaces.lines.transport import FramedLine, wait

CAPACITY = 1024  # messages a receiver may leave lying; lock-step needs two or three
BLOCKED = 600_000_000  # us that a full connection may block before it is given up
LEASE = 60_000  # ms without a sign of life; shorter ones break while a solver holds the machine


def configuration(endpoint: str, listens: bool, security: Security | None) -> zenoh.Config:
    """Build the settings of a session at one endpoint, and nowhere else."""
    check_endpoint(endpoint, security)
    settings: dict[str, Any] = {
        "mode": "peer",
        "scouting/multicast/enabled": False,
        "scouting/gossip/enabled": False,
        "transport/shared_memory/enabled": False,
        "transport/link/tx/lease": LEASE,
        "transport/link/tx/queue/congestion_control/block/wait_before_close": BLOCKED,
        "listen/endpoints": [endpoint] if listens else [],
        "connect/endpoints": [] if listens else [endpoint],
        "connect/timeout_ms": 10_000,
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
    config = zenoh.Config()
    for key, value in settings.items():
        config.insert_json5(key, json.dumps(value))
    return config


class Hub:
    """One session, and who is alive on it; holds the lines that run through it."""

    def __init__(self, endpoint: str, listens: bool, me: str, security: Security | None) -> None:
        self.me = me
        try:
            self.session = zenoh.open(configuration(endpoint, listens, security))
        except zenoh.ZError as error:
            raise LineError(f"endpoint {endpoint}: {me} cannot reach it: {error}") from error
        self._token = self.session.liveliness().declare_token(f"quintet/alive/{me}")
        self._signs = self.session.liveliness().declare_subscriber(
            "quintet/alive/*", handlers.FifoChannel(CAPACITY), history=True
        )
        self.alive: set[str] = set()
        self.gone: set[str] = set()

    def look(self) -> None:
        """Take note of who came and who went."""
        while (sign := self._signs.try_recv()) is not None:
            name = str(sign.key_expr).rsplit("/", 1)[-1]
            if sign.kind == zenoh.SampleKind.DELETE:
                self.gone.add(name)
            else:
                self.alive.add(name)

    def close(self) -> None:
        """End the session; what was sent has been delivered or the run is over."""
        with contextlib.suppress(zenoh.ZError):
            self.session.close()


class ZenohLine(FramedLine):
    """A line between `me` and `other` over a session."""

    def __init__(self, hub: Hub, run: str, other: str, closes_hub: bool = False) -> None:
        super().__init__(run, hub.me)
        self.hub = hub
        self.other = other
        self._closes_hub = closes_hub
        self._inbox = hub.session.declare_subscriber(
            f"quintet/{other}/to/{hub.me}", handlers.FifoChannel(CAPACITY)
        )
        self._outbox = hub.session.declare_publisher(
            f"quintet/{hub.me}/to/{other}",
            congestion_control=zenoh.CongestionControl.BLOCK,
            reliability=zenoh.Reliability.RELIABLE,
            priority=zenoh.Priority.DATA,
        )

    def wait_for_partner(self, seconds: float) -> None:
        """Wait until the other side's subscription is known; earlier messages would vanish."""
        outbox: Any = self._outbox  # its stub says that the status is a truth; it has one
        wait(lambda: outbox.matching_status.matching or None, seconds, self._reason)

    def _put(self, frame: bytearray) -> None:
        try:
            self._outbox.put(frame)
        except zenoh.ZError as error:
            raise LineError(f"cannot send to {self.other}: {error}") from error

    def _poll(self) -> Frame | None:
        try:
            sample = self._inbox.try_recv()
        except zenoh.ZError as error:
            raise LineError(f"the connection to {self.other} is closed: {error}") from error
        return None if sample is None else sample.payload.to_bytes()

    def _broken(self) -> str:
        self.hub.look()
        return f"{self.other} is gone" if self.other in self.hub.gone else ""

    def close(self) -> None:
        """See `Line.close`."""
        if self._closes_hub:
            self.hub.close()


def connect(endpoint: str, name: str, security: Security | None = None) -> ZenohLine:
    """Open a component's line to the coupler."""
    hub = Hub(endpoint, False, name, security)
    line = ZenohLine(hub, "", "coupler", closes_hub=True)
    line.wait_for_partner(30.0)
    return line
