"""A component with every fault that a solver may have, and one that lets others wait in earnest."""

import atexit
import ctypes
import os
import resource
import signal
import subprocess
import sys
import threading
import time
from typing import Literal

import numpy as np
from toys import Toy

from quintet.interfaces.params import Count, parameters

SPARE = 1 << 28  # bytes that are left when memory runs out
LOCK = ctypes.create_string_buffer(64)  # a mutex of the C library
BUSY = "import time\nend = time.time() + {}\nwhile time.time() < end: pass"
OPENS = "import time; time.sleep({}); open('pipe', 'w')"
OUTLIVES = "import os, time\nos.setsid()\ntime.sleep(600)"
# An orphan in a session of its own, without the environment of whoever started it.
SLEEPS = "import time; time.sleep(601)"
ORPHANED = f"""
import subprocess, sys
subprocess.Popen([sys.executable, "-c", "{SLEEPS}"], env={{}}, start_new_session=True)
"""


class Faulty(Toy):
    """Fails in one of its steps, as it is told."""

    @parameters
    class Params:
        items: Count = 5
        pause: float = 0.0
        substeps: Count = 1
        seen: bool = False
        talks: bool = False
        fails_at: int = -1
        fails_by: Literal[
            "exception", "sys.exit", "os._exit", "SIGKILL", "SIGSTOP", "deadlock", "endless loop",
            "compiled loop", "polling loop", "NaN", "wrong shape", "out of memory", "SIGSEGV",
            "impulse of wrong shape", "complex", "None", "huge",
        ] = "exception"  # fmt: skip
        moment: str = ""  # file for the time of the failure
        child: bool = False  # whether it has a child process, in a session of its own
        orphan: bool = False  # whether it has started a process whose parent has ended

    def __init__(self, params):
        super().__init__(params)
        self.odd = {}  # what it gives in place of its fields
        self.endless = compiled() if params.fails_by == "compiled loop" else None
        if params.child:
            subprocess.Popen([sys.executable, "-c", OUTLIVES])
        if params.orphan:
            subprocess.run([sys.executable, "-c", ORPHANED], check=True)

    def fail(self):
        with open(self.params.moment, "w") as file:
            file.write(repr(time.time()))
        match self.params.fails_by:
            case "exception":
                raise ArithmeticError("asked to raise")
            case "sys.exit":
                sys.exit(0)
            case "os._exit":
                os._exit(0)
            case "SIGKILL":
                os.kill(os.getpid(), signal.SIGKILL)
            case "SIGSEGV":
                os.kill(os.getpid(), signal.SIGSEGV)
            case "SIGSTOP":
                os.kill(os.getpid(), signal.SIGSTOP)
            case "deadlock":
                libc = ctypes.PyDLL(None)  # which holds the interpreter's lock
                libc.pthread_mutex_lock(LOCK)
                libc.pthread_mutex_lock(LOCK)
            case "endless loop":
                while True:
                    pass
            case "compiled loop":
                self.endless(1)
            case "polling loop":
                while not os.path.exists("/never/there"):
                    time.sleep(0.001)
            case "NaN":
                self.value = np.full_like(self.value, np.nan)
            case "wrong shape":
                self.value = np.zeros((2, 3))
            case "impulse of wrong shape":
                self.odd = {"out.push": np.ones((1, 3))}
            case "complex":
                self.odd = {"out.number": self.value + 1j}
            case "None":
                self.odd = {"out.push": None}
            case "huge":  # 6 GB, of which nothing is in memory
                self.odd = {"out.number": np.broadcast_to(0.0, (250_000_000, 3))}
            case "out of memory":
                exhaust()

    def give(self, wanted):
        return super().give(wanted) | self.odd


def wait_as_for_a_disk(seconds):
    """Wait uninterruptibly: who starts a process does, until that one has opened its files."""
    os.mkfifo("pipe")
    subprocess.Popen([sys.executable, "-c", OPENS.format(seconds)])
    opens = [(os.POSIX_SPAWN_OPEN, 0, "pipe", os.O_RDONLY, 0)]
    os.waitpid(os.posix_spawn("/bin/true", ["true"], {}, file_actions=opens), 0)
    os.remove("pipe")


def exhaust():
    """Allocate until there is none left."""
    with open("/proc/self/statm") as file:
        used = int(file.read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + SPARE, resource.RLIM_INFINITY))
    held = []
    while True:
        held.append(np.ones(1000))


def compiled():
    """Compile a loop without end for numbers above zero, without the interpreter's lock."""
    from numba import njit  # only this fault compiles

    @njit(nogil=True)
    def endless(n):
        while n > 0:
            n = 3 if n == 7 else 7
        return n

    endless(0)
    return endless


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
            end = time.time() + params.seconds
            while time.time() < end:
                pass

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


class Hanging(Toy):
    """Hangs as it is built, or as the process that it is in ends."""

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


def hold_the_lock():
    """Wait for ever in C, with the interpreter's lock held."""
    library = ctypes.PyDLL(None)
    library.pthread_mutex_lock(LOCK)
    library.pthread_mutex_lock(LOCK)
