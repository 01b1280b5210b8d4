"""How far a run has come, in a file that outlives the process that writes it."""

import contextlib
import mmap
import struct
from pathlib import Path

NAME = "reached"  # in the log folder of a run
FORM = struct.Struct("<qd")  # windows done; time reached [s]


class Reached:
    """Windows done and time reached; a write costs less than a microsecond."""

    def __init__(self, path: Path) -> None:
        path.write_bytes(FORM.pack(0, 0.0))
        with open(path, "r+b") as file:
            self._memory = mmap.mmap(file.fileno(), FORM.size)

    def note(self, windows: int, time: float) -> None:
        """Note the windows done and the time reached [s]."""
        FORM.pack_into(self._memory, 0, windows, time)

    @staticmethod
    def read(path: Path) -> tuple[int, float]:
        """Windows done and time reached [s]; 0 where nothing was noted."""
        with contextlib.suppress(OSError, struct.error):
            windows, time = FORM.unpack(path.read_bytes())
            return max(0, windows), time
        return 0, 0.0
