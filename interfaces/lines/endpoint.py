"""The endpoint at which a coupler listens: on the loopback, or with mutual TLS."""

import re
import socket
from dataclasses import dataclass

from quintet.interfaces.errors import LineError, SceneError

ENDPOINT = re.compile(r"(tcp|tls)/(\[[0-9A-Fa-f:]+\]|[\w.-]+):(\d{1,5})")
HIGHEST = 65535  # port
LOOPBACK = ("127.0.0.1", "localhost", "[::1]")


@dataclass(frozen=True, slots=True)
class Security:
    """Files for mutual TLS: the certificate authority of both sides, a certificate and its key."""

    authority: str
    certificate: str
    key: str


def check_endpoint(endpoint: str, security: Security | None) -> None:
    """Refuse an endpoint that is reachable over a network without mutual TLS."""
    match = ENDPOINT.fullmatch(endpoint)
    if match is None:
        raise LineError(
            f"endpoint {endpoint!r}: must be tcp/HOST:PORT on the loopback or tls/HOST:PORT."
        )
    protocol, host, port = match.groups()
    if not 0 < int(port) <= HIGHEST:
        raise LineError(
            f"endpoint {endpoint!r}: the port must be from 1 to {HIGHEST}; found {port}. Choose "
            "one that is free, or give no endpoint."
        )
    if protocol == "tcp" and host not in LOOPBACK:
        raise LineError(
            f"endpoint {endpoint!r}: off the loopback only tls with certificates on both sides "
            "is allowed. Use tls/HOST:PORT and give authority, certificate and key."
        )
    if protocol == "tls" and security is None:
        raise LineError(f"endpoint {endpoint!r}: tls needs authority, certificate and key.")


def on_loopback(endpoint: str) -> bool:
    """Whether an endpoint is reached from its own host only."""
    match = ENDPOINT.fullmatch(endpoint)
    return match is not None and match[2] in LOOPBACK


def require_free(endpoint: str) -> None:
    """Refuse an endpoint at which this machine cannot listen: another run does, or it is not its.

    Whoever takes it later is noticed when the line is opened.
    """
    match = ENDPOINT.fullmatch(endpoint)
    if match is None:
        return
    host, port = match[2].strip("[]"), int(match[3])
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(
            host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )[0]
        with socket.socket(family, kind, protocol) as probe:
            # What a former run left behind, its connections closed, is in nobody's way.
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            probe.bind(address)
            probe.listen()
    except OSError as error:
        raise SceneError(
            f"scene.endpoint {endpoint}: the coupler must be able to listen there; it cannot "
            f"({error.strerror or error}). End what uses the port, name another, or give no "
            "endpoint."
        ) from error


def free_port() -> int:
    """Return a free port of the loopback."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])
