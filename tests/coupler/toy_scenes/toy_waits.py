"""Components that let others wait: for a good reason, during their build, or at their exit."""

import atexit
import os
import subprocess
import sys
import threading
import time
from typing import Literal

from toy_faults import hold_the_lock
from toys import Toy

from quintet.interfaces.params import Count, parameters

BUSY = "import time\nend = time.time() + {}\nwhile time.time() < end: pass"
OPENS = "import time; time.sleep({}); open('pipe', 'w')"


def wait_as_for_a_disk(seconds):
    """Wait uninterruptibly: a parent waits so until its child process has opened its files."""
    os.mkfifo("pipe")
    subprocess.Popen([sys.executable, "-c", OPENS.format(seconds)])
    opens = [(os.POSIX_SPAWN_OPEN, 0, "pipe", os.O_RDONLY, 0)]
    os.waitpid(os.posix_spawn("/bin/true", ["true"], {}, file_actions=opens), 0)
    os.remove("pipe")


def compute(seconds):
    """Compute for so long, by the clock."""
    end = time.time() + seconds
    while time.time() < end:
        pass


class Waiting(Toy):
    """Lets the others wait for a good reason."""

    @parameters
    class Params:
        items: Count = 5
        pause: float = 0.0
        substeps: Count = 1
        seen: bool = False
        talks: bool = False
        fails_at: int = 30
        fails_by: Literal["", "lock", "disk", "child", "build", "first", "programs"] = ""
        seconds: float = 0.0

    def __init__(self, params):
        super().__init__(params)
        if params.fails_by == "build":
            compute(params.seconds)

    def step(self, dt):
        if self.params.fails_by == "first" and self.steps == 0:
            time.sleep(self.params.seconds)
        super().step(dt)

    def fail(self):
        seconds = self.params.seconds
        match self.params.fails_by:
            case "lock":
                lock = threading.Lock()
                lock.acquire()
                lock.acquire(timeout=seconds)
            case "disk":
                wait_as_for_a_disk(seconds)
            case "child":
                subprocess.run([sys.executable, "-c", BUSY.format(seconds)], check=True)
            case "programs":  # one after the other, each short
                end = time.time() + seconds
                while time.time() < end:
                    subprocess.run([sys.executable, "-c", BUSY.format(0.2)], check=True)


class Slow(Toy):
    """Has long windows, of so many seconds per 1 ms, in which it sleeps or computes."""

    @parameters
    class Params:
        seconds: tuple[float, ...] = ()  # s, of each window; the last for all that follow
        computes: bool = False
        items: Count = 5
        pause: float = 0.0
        substeps: Count = 1
        seen: bool = False
        talks: bool = False
        fails_at: int = -1
        fails_by: str = ""

    def step(self, dt):
        window, all_seconds = int(self.time / 1e-3 + 1e-6), self.params.seconds
        seconds = all_seconds[min(window, len(all_seconds) - 1)] * dt / 1e-3
        compute(seconds) if self.params.computes else time.sleep(seconds)
        super().step(dt)


class Hanging(Toy):
    """Hangs during its build, or at the exit of its process."""

    @parameters
    class Params:
        items: Count = 5
        pause: float = 0.0
        substeps: Count = 1
        seen: bool = False
        talks: bool = False
        fails_at: int = -1
        fails_by: Literal["sleeps", "computes", "locks", "thread at exit", "lock at exit"]

    def __init__(self, params):
        super().__init__(params)
        match params.fails_by:
            case "sleeps":
                time.sleep(600.0)
            case "computes":
                while True:
                    pass
            case "locks":
                hold_the_lock()
            case "thread at exit":
                threading.Thread(target=time.sleep, args=(600.0,)).start()
            case "lock at exit":
                atexit.register(hold_the_lock)
