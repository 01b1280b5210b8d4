"""Secrets of awaited components in files that only their own user can read, for plain tcp.

A plain connection is confined to the loopback, so that both processes see the same files. Who joins
proves that it has read the file, and the secret is never sent.
"""

import hmac
import os
import stat
from collections.abc import Iterable
from hashlib import blake2b
from pathlib import Path

from quintet.interfaces.errors import LineError
from quintet.interfaces.lines.endpoint import ENDPOINT

PLACE = Path("/tmp")  # not that of TMPDIR, which the two processes may see differently


def folder() -> Path:
    """Folder of the secrets of this user."""
    return PLACE / f"quintet-{os.getuid()}"


def path_of(endpoint: str, name: str) -> Path:
    """File of the secret with which a component joins at an endpoint."""
    match = ENDPOINT.fullmatch(endpoint)
    return folder() / f"{match[3] if match else ''}-{name}"


def write(endpoint: str, name: str, secret: str) -> None:
    """Write a secret, in the place of one that a run at this endpoint wrote before."""
    folder().mkdir(mode=0o700, exist_ok=True)
    _require_private(folder())
    path = path_of(endpoint, name)
    unfinished = path.with_name(f"{path.name}.{os.getpid()}")
    file = os.open(unfinished, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_NOFOLLOW, 0o600)
    with open(file, "w") as text:
        text.write(secret)
    unfinished.replace(path)


def remove(endpoint: str, names: Iterable[str]) -> None:
    """Remove the files of a run, and the folder if it was the last."""
    for name in names:
        path_of(endpoint, name).unlink(missing_ok=True)
    try:
        folder().rmdir()
    except OSError:
        return  # of other runs


def read(endpoint: str, name: str) -> str:
    """Secret with which a component may join; "" where this user has none."""
    try:
        _require_private(folder())
        return path_of(endpoint, name).read_text()
    except FileNotFoundError:
        return ""


def proof(secret: str, name: str, request: str) -> str:
    """Show with a request that its sender knows the secret."""
    text = f"{name} {request}".encode()
    return blake2b(text, key=secret.encode(), person=b"quintet join", digest_size=16).hexdigest()


def proves(shown: object, secret: str, name: str, request: str) -> bool:
    """Whether a proof is that of the secret and the request."""
    expected = proof(secret, name, request)
    return isinstance(shown, str) and hmac.compare_digest(shown.encode(), expected.encode())


def _require_private(place: Path) -> None:
    about = place.lstat()
    if not stat.S_ISDIR(about.st_mode) or about.st_uid != os.getuid() or about.st_mode & 0o077:
        raise LineError(
            f"{place} must be a folder of user {os.getuid()} with mode 0700: components read there "
            "the secrets with which they join. It is not; remove it."
        )
