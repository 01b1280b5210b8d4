"""The endpoint at which a coupler listens: on the loopback, or with mutual TLS."""

import re
from dataclasses import dataclass

from quintet.interfaces.errors import LineError

ENDPOINT = re.compile(r"(tcp|tls)/(\[[0-9A-Fa-f:]+\]|[\w.-]+):\d{1,5}")
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
    protocol, host = match.groups()
    if protocol == "tcp" and host not in LOOPBACK:
        raise LineError(
            f"endpoint {endpoint!r}: off the loopback only tls with certificates on both sides "
            "is allowed. Use tls/HOST:PORT and give authority, certificate and key."
        )
    if protocol == "tls" and security is None:
        raise LineError(f"endpoint {endpoint!r}: tls needs authority, certificate and key.")
