"""Why an endpoint cannot be used, found before zenoh connects, which reports all causes alike."""

import contextlib
import socket
import ssl
import time
from collections.abc import Callable
from typing import NamedTuple

from quintet.interfaces.lines.endpoint import ENDPOINT, Security

SECONDS = 3.0  # s for each step of a connection
RETRY = 0.1  # s between two tries to connect where nobody listens
NO_MESSAGE = b"\x03\x00\xff\xff\xff"  # 3 bytes that no version of zenoh takes for a message
ZENOH_CLOSE = b"\x02\x00\x03"  # how a message of zenoh begins that closes a connection
TLS_ALERT = 0x15
EXPIRED, NOT_YET_VALID, WRONG_NAMES = 10, 9, (62, 64)  # verify codes of OpenSSL
NOT_FOR_SERVERS = 26
UNKNOWN_AUTHORITY = (18, 19, 20, 21)
OTHER_CLIENTS = "unknown ca", "bad certificate", "certificate unknown", "decrypt error"


class Obstacle(NamedTuple):
    """Why an endpoint cannot be used; it is only suspected where zenoh may still know better."""

    text: str = ""
    certain: bool = True


def await_listener(endpoint: str, seconds: float, say: Callable[[str], object]) -> None:
    """Wait until somebody listens at an endpoint, at most so long; say what is waited for."""
    match = ENDPOINT.fullmatch(endpoint)
    if match is None:
        return
    limit = time.monotonic() + seconds
    is_reported = False
    while time.monotonic() < limit:
        try:
            socket.create_connection((match[2].strip("[]"), int(match[3])), SECONDS).close()
        except ConnectionRefusedError:
            if not is_reported:
                say(f"nobody listens at {endpoint} yet; waiting for up to {seconds:g} s")
            is_reported = True
            time.sleep(RETRY)
        except OSError:
            return  # `obstacle` says why
        else:
            return


def obstacle(endpoint: str, security: Security | None) -> Obstacle:
    """Connect, and make the TLS handshake where there is one; return what is in the way."""
    match = ENDPOINT.fullmatch(endpoint)
    if match is None:
        return Obstacle()
    protocol, host, port = match[1], match[2].strip("[]"), int(match[3])
    try:
        reply = _reply(host, port)
    except socket.gaierror as error:
        return Obstacle(f"the name {host} is not known here ({error.strerror}). Correct the host.")
    except ConnectionRefusedError:
        return Obstacle(
            f"nobody listens on port {port} of {host}. The run has not begun, or it has ended: "
            "start it, and give its endpoint."
        )
    except OSError as error:
        return Obstacle(
            f"{host} cannot be reached within {SECONDS:g} s ({error.strerror or error}). Look at "
            "the network and its firewalls."
        )
    if reply[:1] == bytes([TLS_ALERT]):
        if protocol == "tcp" or security is None:
            return Obstacle(
                "the run listens with tls; a plain connection was tried. Give tls/HOST:PORT and a "
                "scene with its certificates."
            )
        return _of_handshake(host, port, security)
    if reply.startswith(ZENOH_CLOSE) and protocol == "tls":
        return Obstacle(
            "the run listens with plain tcp; tls was tried. Give the endpoint that the run prints."
        )
    if reply and not reply.startswith(ZENOH_CLOSE):
        answer = f"it answers {reply[:20]!r}"
        return Obstacle(f"what listens there is no run of quintet ({answer}). Correct the port.")
    silent = "what listens there does not answer as a run of quintet does. Correct the port."
    return Obstacle() if reply else Obstacle(silent, certain=False)


def _reply(host: str, port: int) -> bytes:
    """What a listener answers to bytes that are no message; b"" where it is silent."""
    with socket.create_connection((host, port), SECONDS) as link:
        with contextlib.suppress(TimeoutError, ConnectionResetError, BrokenPipeError):
            link.sendall(NO_MESSAGE)
            return link.recv(64)
    return b""


def _of_handshake(host: str, port: int, security: Security) -> Obstacle:
    """What is in the way of mutual TLS with a listener."""
    try:
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
        context.hostname_checks_common_name = False
        context.load_verify_locations(security.authority)
        context.load_cert_chain(security.certificate, security.key)
    except (OSError, ssl.SSLError) as error:
        return Obstacle(
            f"the files {security.authority}, {security.certificate} and {security.key} must be an "
            f"authority, a certificate and its key in PEM ({error}). Correct scene.tls."
        )
    try:
        with (
            socket.create_connection((host, port), SECONDS) as link,
            context.wrap_socket(link, server_hostname=host) as secured,
        ):
            # The listener judges our certificate after the handshake, and says so first.
            secured.sendall(NO_MESSAGE)
            secured.recv(64)
    except ssl.SSLCertVerificationError as error:
        return Obstacle(_of_certificate(host, error, security))
    except ssl.SSLError as error:
        reason = str(error.reason or error).lower().replace("_", " ")
        if "certificate required" in reason:
            return Obstacle("the run asks for a certificate; none was shown. Correct scene.tls.")
        if "expired" in reason:
            return Obstacle(
                f"the run refuses the certificate {security.certificate}: it has expired. Renew it."
            )
        if any(words in reason for words in OTHER_CLIENTS):
            return Obstacle(
                f"the run refuses the certificate {security.certificate}: its authority did not "
                "sign it. Use a certificate of the run's authority."
            )
        return Obstacle(f"the TLS handshake failed ({reason}). Compare the certificates.")
    except OSError as error:
        return Obstacle(f"the TLS handshake was not answered ({error}).", certain=False)
    return Obstacle()


def _of_certificate(host: str, error: ssl.SSLCertVerificationError, security: Security) -> str:
    """Say why the certificate that a listener shows is not accepted."""
    if error.verify_code in UNKNOWN_AUTHORITY:
        return (
            f"the certificate shown there is not signed by the authority {security.authority}. "
            "Both sides must use certificates of one authority: correct scene.tls."
        )
    if error.verify_code in WRONG_NAMES:
        return (
            f"the certificate shown there is not valid for {host}. Its subjectAltName must have "
            "the host of the endpoint: use that name, or issue the certificate for it."
        )
    if error.verify_code == NOT_FOR_SERVERS:
        return (
            "the certificate shown there is that of a component, with which nothing may listen. "
            "Start the run with the certificate of its coupler."
        )
    if error.verify_code in (EXPIRED, NOT_YET_VALID):
        state = "has expired" if error.verify_code == EXPIRED else "is not valid yet"
        return f"the certificate shown there {state}. Renew it, or set the clock of this host."
    return f"the certificate shown there is refused ({error.verify_message}). Renew it."
