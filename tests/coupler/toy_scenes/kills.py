"""Kills of processes of a run at random moments, and the work that each kill loses."""

import contextlib
import json
import os
import random
import re
import signal
import subprocess
import time
from pathlib import Path

from started import Started

from quintet.coupler.files.reached import NAME, Reached

WHO = ("component", "rank", "coupler", "host")
SERVES = b"quintet.interfaces.serving.process"
ENDING = 60.0  # s for a run to end after its coupler was killed


class Killed:
    """A run whose processes are killed; it is resumed if a kill ends it.

    To imitate a host that goes down, all processes of the run are killed at the same moment.
    """

    def __init__(self, scene, folder, arguments, seed, kills, seconds, target="any"):
        self.scene, self.folder, self.arguments = scene, folder, arguments
        self.told = []  # each killed process, and the time
        self._lost = []  # s of work, of kills after which the run was resumed
        self._said = ""  # on the screen, by runs that were resumed
        self.run = Started(scene, *arguments, out=folder)
        choice = random.Random(f"kills {seed}")
        moments = sorted(choice.uniform(0.0, seconds) for _ in range(kills))
        start = time.monotonic()
        for moment in moments:
            while time.monotonic() - start < moment and self.run.process.poll() is None:
                time.sleep(0.005)
            if self.run.process.poll() is not None:
                break
            self._kill(choice.choice(WHO) if target == "any" else target, choice, moment)

    def lost(self):
        """Seconds of work that were lost with each kill."""
        taken_over = re.findall(r"took over after ([\d.]+) s", self._said + self.run.err)
        return self._lost + [float(seconds) for seconds in taken_over]

    def _kill(self, target, choice, moment):
        components = self._components()
        coupler = self._coupler()
        if target in ("component", "rank") and not components:
            target = "coupler"  # no component has begun yet
        self.told.append(f"{target} at {moment:.2f} s")
        if target in ("component", "rank"):
            rank_pids = [pid for pid in components if b"--ranks" in words_of(pid)]
            candidates = rank_pids if target == "rank" and rank_pids else components
            end(choice.choice(sorted(candidates)))
            return
        saved = [path.stat().st_mtime for path in self.folder.glob("snapshot-*.h5")]
        start = Path(f"/proc/{self.run.process.pid}").stat().st_mtime
        # Without windows, only a start is lost.
        windows = Reached.read(self.folder / "log" / NAME)[0]
        self._lost.append(time.time() - max([*saved, start]) if windows else 0.0)
        pids = self.run.processes() if target == "host" else [coupler]
        shared = {path for pid in pids for path in mapped(pid)} if target == "host" else ()
        for pid in pids:
            end(pid)
        self._go_on(shared, bool(saved))

    def _go_on(self, shared, saved):
        """Wait for the end of the run, and resume it, or begin again before the first snapshot.

        A host that goes down loses its shared memory with it.
        """
        run = self.run
        with contextlib.suppress(subprocess.TimeoutExpired):
            run.out, run.err = run.process.communicate(timeout=ENDING)
        self._said += run.err
        remaining = run.left_processes(5.0)
        assert not remaining, f"{remaining} left after {self.told}"
        for path in shared:
            Path(path).unlink(missing_ok=True)
        assert not run.left_in_shared_memory(), self.told
        arguments = () if saved else (*self.arguments, "--force")
        self.run = Started(self.scene, *arguments, out=self.folder, resumes=saved)
        self.told[-1] += ", resumed" if saved else ", begun again"

    def _components(self):
        """Processes of components of the run, ranks included."""
        return [
            pid
            for pid in self.run.processes()
            if SERVES in (words := words_of(pid)) and words[0].endswith((b"python", b"python3"))
        ]

    def _coupler(self):
        """The process that couples; over MPI it is a child of the run."""
        try:
            job = json.loads((self.folder / "log" / "mpi.json").read_text())
            return int(job["coupler"]) or self.run.process.pid
        except (OSError, ValueError, KeyError):
            return self.run.process.pid


def words_of(pid):
    """Command line of a process."""
    try:
        return Path(f"/proc/{pid}/cmdline").read_bytes().split(b"\0")
    except OSError:
        return [b""]


def mapped(pid):
    """Files in shared memory that a process maps."""
    try:
        return re.findall(r"/dev/shm/\S+", Path(f"/proc/{pid}/maps").read_text())
    except OSError:
        return []


def end(pid):
    """Kill a process."""
    with contextlib.suppress(ProcessLookupError):
        os.kill(pid, signal.SIGKILL)
