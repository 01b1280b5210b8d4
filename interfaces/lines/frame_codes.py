"""Authentication codes of the frames of a line: a message without the right one is dropped.

Both ends of a line know a secret, which is never sent over it. A code is the number of the message
and its AES-256-GMAC (NIST SP 800-38D, with the number as nonce), under a key for one direction.
Thus a message that was forged, damaged or sent again is recognised before it is decoded.
"""

import hmac
import struct
import time
from collections.abc import Callable
from dataclasses import dataclass
from hashlib import blake2b

from quintet.interfaces.lines.message import Frame

CODE = struct.Struct("<Q16s")  # number of the message, authentication code
NONCE = 12  # bytes
REPEATED = 10.0  # s between two reports


def topic_of(secret: str) -> str:
    """Part of the keys of a line; from it the secret cannot be found."""
    return blake2b(key=secret.encode(), person=b"quintet topic", digest_size=16).hexdigest()


@dataclass
class DroppedFrames:
    """Messages on keys of a run that were dropped: forged or damaged, or sent again."""

    invalid: int = 0
    repeated: int = 0
    tell: Callable[[str], object] = lambda text: None  # called at most once in ten seconds
    _tell_at: float = 0.0

    def count(self) -> int:
        """All of them."""
        return self.invalid + self.repeated

    def summary(self) -> list[str]:
        """What was dropped so far, in sentences."""
        sentences = []
        if self.invalid:
            sentences.append(
                f"{self.invalid} message(s) on keys of the run had no valid authentication code "
                "and were dropped: they were damaged on the way, or another program sent them."
            )
        if self.repeated:
            sentences.append(
                f"{self.repeated} message(s) on keys of the run arrived a second time and were "
                "dropped."
            )
        return sentences

    def report(self) -> None:
        """Tell the summary, unless it was told a short while ago."""
        now = time.monotonic()
        if now >= self._tell_at:
            self._tell_at = now + REPEATED
            self.tell(" ".join(self.summary()))


class FrameCodes:
    """Codes of one direction of a line.

    Parameters
    ----------
    secret : str
        Of the line. A key must never be used for two messages with one number: each process of a
        component gets a secret of its own.
    sender, receiver : str
        Names of both ends.
    """

    def __init__(self, secret: str, sender: str, receiver: str) -> None:
        # Only processes that are joined over a network load it.
        from cryptography.hazmat.primitives.ciphers.aead import AESGCM

        direction = f"{sender}/to/{receiver}".encode()
        seed = blake2b(direction, key=secret.encode(), person=b"quintet frames", digest_size=32)
        self._cipher = AESGCM(seed.digest())
        self.receiver = receiver
        self.number = 0  # of the next message

    def add(self, frame: bytearray) -> None:
        """Write the code of the next message that is sent into the room behind its frame."""
        end = len(frame) - CODE.size
        CODE.pack_into(frame, end, self.number, self._tag(self.number, memoryview(frame)[:end]))
        self.number += 1

    def open(self, received: bytes, dropped: DroppedFrames) -> Frame | None:
        """Return the frame of a new message without its code; None, and count it, if it is none.

        Numbers may be left out: a message that was lost is sent again under another number. What is
        missing is found by the number in its header (`FramedLine.receive`).
        """
        end = len(received) - CODE.size
        if end < 0:
            dropped.invalid += 1
            return None
        frame = memoryview(received)[:end]
        number, tag = CODE.unpack_from(received, end)
        if not hmac.compare_digest(tag, self._tag(number, frame)):
            dropped.invalid += 1
            return None
        if number < self.number:
            dropped.repeated += 1
            return None
        self.number = number + 1
        return frame

    def _tag(self, number: int, frame: Frame) -> bytes:
        return self._cipher.encrypt(number.to_bytes(NONCE, "little"), b"", frame)
