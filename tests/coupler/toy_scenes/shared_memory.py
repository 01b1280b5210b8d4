"""Files in shared memory used by the processes of one run, also beside other runs."""

import os
import threading
import time
from pathlib import Path

SHARED = "/dev/shm/"
INTERVAL = 0.3  # s between two looks at the processes while they run


class SharedFiles:
    """Notes which files in shared memory the processes of a run map or open.

    Parameters
    ----------
    processes : function
        Returns the numbers of the run's processes.
    is_over : function
        Whether the run has ended.
    """

    def __init__(self, processes, is_over):
        self.processes, self.is_over = processes, is_over
        self.before = set(os.listdir(SHARED))
        self.used = set()  # names, by processes of this run
        threading.Thread(target=self._watch, daemon=True).start()

    def _watch(self):
        while not self.is_over():
            self.note()
            time.sleep(INTERVAL)

    def note(self):
        """Note the files that the run's processes use now."""
        for pid in self.processes():
            self.used |= _files_of(Path(f"/proc/{pid}"))

    def left(self, seconds):
        """New files that only this run's processes used; they have some time to be deleted."""
        limit = time.monotonic() + seconds
        self.note()
        while (files := self._left()) and time.monotonic() < limit:
            time.sleep(INTERVAL)
        return files

    def _left(self):
        files = (self.used - self.before) & set(os.listdir(SHARED))
        if not files:
            return files
        for process in Path("/proc").glob("[0-9]*"):
            files -= _files_of(process)
        return files


def _files_of(process):
    """Names of the files in shared memory that a process maps or has open."""
    names = set()
    try:
        for line in (process / "maps").read_text().splitlines():
            names.add(line.rpartition(SHARED)[2] if SHARED in line else "")
        for link in (process / "fd").iterdir():
            path = os.readlink(link)
            names.add(path.removeprefix(SHARED) if path.startswith(SHARED) else "")
    except OSError:  # it has ended meanwhile
        pass
    return {name.removesuffix(" (deleted)") for name in names} - {""}
