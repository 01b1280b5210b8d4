"""A disk of a few megabytes that is filled and emptied while a run goes on."""

import contextlib
import resource
import subprocess
import time
from pathlib import Path

SIZE = 64  # MB
CHUNK = 1 << 12


class SmallDisk:
    """A disk in memory, mounted in a private namespace; tests reach it through /proc."""

    def __init__(self, folder):
        self.place = folder / "small"
        self.place.mkdir()
        mount = f"mount -t tmpfs -o size={SIZE}m none {self.place} && echo ready && exec sleep 600"
        self.holder = subprocess.Popen(
            ["unshare", "-rm", "sh", "-c", mount], stdout=subprocess.PIPE, stderr=subprocess.PIPE
        )
        self.allowed = self.holder.stdout.readline() == b"ready\n"
        self.within = ["nsenter", "--preserve-credentials", "-U", "-m", f"-t{self.holder.pid}"]

    def seen(self, path):
        """Where a file of the disk is seen from here."""
        return Path(f"/proc/{self.holder.pid}/root{path}")

    def fill(self, *_):
        """Leave no byte free, also of the space that a run reserves only for a moment."""
        with open(self.seen(self.place / "ballast"), "wb", buffering=0) as file:
            for _ in range(20):
                with contextlib.suppress(OSError):
                    while True:
                        file.write(bytes(CHUNK))
                time.sleep(0.005)

    def empty(self):
        """Make room again."""
        self.seen(self.place / "ballast").unlink()

    def close(self):
        """Unmount the disk; its files are lost."""
        self.holder.kill()
        self.holder.communicate()


class SizeLimit:
    """A limit on the size of files, where no disk can be mounted: a run meets it as a full disk."""

    within = ()
    allowed = True

    def __init__(self, folder):
        self.place = folder

    def seen(self, path):
        """Where a file is seen from here."""
        return Path(path)

    def fill(self, pid, path):
        """Stop the growth of a file of a process; smaller files may still grow."""
        size = max(path.stat().st_size // 2 if path.suffix == ".h5" else 0, 1 << 14)
        resource.prlimit(pid, resource.RLIMIT_FSIZE, (size, resource.RLIM_INFINITY))

    def empty(self):
        """Let files grow again: processes started from now on have no limit."""

    def close(self):
        """Do nothing: no disk is mounted."""
