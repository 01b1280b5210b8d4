"""Signs of life between hosts, which come also while a solver holds the interpreter's lock.

A component on another host opens a second session of zenoh, with a short lease. Threads of zenoh
keep it alive; they need no lock of Python's. When nothing has arrived for the lease, the coupler
loses the liveliness token of this session. Its own thread connects again as soon as it can, and
the token comes back. The session of the messages has a long lease: TCP sends again what was lost.
"""

import time

import zenoh
from zenoh import handlers

from quintet.interfaces.errors import LineError
from quintet.interfaces.lines.endpoint import Security
from quintet.interfaces.lines.zenoh import Session, configuration

SILENCE = 6.0  # s without any sign of life until a host is said not to answer
LEASE = int(1000 * SILENCE)  # ms


class Signs:
    """A session that gives signs of life of one component until it is closed."""

    def __init__(self, endpoint: str, security: Security | None, root: str, name: str) -> None:
        try:
            self._session = zenoh.open(configuration(endpoint, False, security, LEASE))
        except zenoh.ZError as error:
            raise LineError(f"endpoint {endpoint}: a second connection failed: {error}") from error
        self._token = self._session.liveliness().declare_token(_key(root, name))

    def close(self) -> None:
        """Give no more."""
        self._session.close()


class SignsOfLife:
    """The signs of life of one component, as the coupler gets them."""

    def __init__(self, session: Session, name: str) -> None:
        self._tokens = session.zenoh.liveliness().declare_subscriber(
            _key(session.root, name), handlers.FifoChannel(1024), history=True
        )
        self._lost_at = 0.0  # s of the monotonic clock; 0 while there are signs

    def silent_for(self) -> float:
        """Time since the last sign of life [s]; 0 as long as they come, and before the first."""
        while (sample := self._tokens.try_recv()) is not None:
            lost = sample.kind == zenoh.SampleKind.DELETE
            self._lost_at = time.monotonic() if lost else 0.0
        return time.monotonic() - self._lost_at + SILENCE if self._lost_at else 0.0


def _key(root: str, name: str) -> str:
    return f"{root}/alive/{name}~sign"
