"""Every fault that a solver may have, and a component that fails at a chosen moment of its run."""

import ctypes
import gc
import os
import resource
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Literal, get_args

import numpy as np
from toys import Toy

from quintet.interfaces.params import Count, parameters

Cause = Literal[
    "exception", "sys.exit", "os._exit", "SIGKILL", "SIGSEGV", "SIGSTOP", "deadlock",
    "endless loop", "compiled loop", "locked loop", "polling loop", "NaN", "wrong shape",
    "impulse of wrong shape", "complex", "None", "huge", "out of memory", "disk full", "link cut",
]  # fmt: skip
# `step`: in step `fails_at`; `give`, `save`: after that step; `between`: 1 ms after its outputs;
# `later`: so many steps after it was saved last; `finish`: when its last warnings are asked for.
Moment = Literal["never", "build", "step", "give", "between", "save", "later", "finish"]
CAUSES = get_args(Cause)
SPARE = 1 << 28  # bytes that are left when memory runs out
LOCK = ctypes.create_string_buffer(64)  # a mutex of the C library
SOON = 1e-3  # s after an answer, while the partner still steps
OUTLIVES = "import os, time\nos.setsid()\ntime.sleep(600)"
# An orphan in a session of its own, without the environment of whoever started it.
SLEEPS = "import time; time.sleep(601)"
ORPHANED = f"""
import subprocess, sys
subprocess.Popen([sys.executable, "-c", "{SLEEPS}"], env={{}}, start_new_session=True)
"""


def due(params):
    """Whether to fail now: `times` in all, at moments that are noted in a file."""
    path = Path(params.moment)
    failures = path.read_text().count("\n") if path.is_file() else 0
    if failures >= params.times:
        return False
    with open(path, "a") as file:
        file.write(f"{time.time()!r}\n")
    return True


def fail(cause, endless=None):
    """Fail in running code; causes that spoil outputs do nothing here."""
    match cause:
        case "exception":
            raise ArithmeticError("asked to raise")
        case "sys.exit":
            sys.exit(0)
        case "os._exit":
            os._exit(0)
        case "SIGKILL" | "SIGSEGV" | "SIGSTOP":
            os.kill(os.getpid(), getattr(signal, cause))
        case "deadlock":
            hold_the_lock()
        case "endless loop":
            while True:
                pass
        case "compiled loop" | "locked loop":
            endless(1)
        case "polling loop":
            while not os.path.exists("/never/there"):
                time.sleep(0.001)
        case "out of memory":
            exhaust()
        case "disk full":
            with open("/dev/full", "wb") as file:  # the system's file that never has room
                file.write(b"results of the solver")
        case "link cut":
            cut_link()


def hold_the_lock():
    """Wait for ever in C, with the interpreter's lock held."""
    library = ctypes.PyDLL(None)
    library.pthread_mutex_lock(LOCK)
    library.pthread_mutex_lock(LOCK)


def exhaust():
    """Allocate until there is none left."""
    with open("/proc/self/statm") as file:
        used = int(file.read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + SPARE, resource.RLIM_INFINITY))
    arrays = []
    for size in (1_000_000, 1000):  # soon, and then to the last
        try:
            while True:
                arrays.append(np.empty(size))
        except MemoryError:
            if size == 1000:
                raise


def cut_link():
    """Close the connection of this process to the coupler; the process lives on."""
    sessions = sys.modules["quintet.interfaces.lines.zenoh"].Session
    for session in [instance for instance in gc.get_objects() if isinstance(instance, sessions)]:
        session.zenoh.close()


def compiled(nogil):
    """Compile a loop without end for numbers above zero."""
    from numba import njit  # only these faults compile

    @njit(nogil=nogil)
    def endless(n):
        while n > 0:
            n = 3 if n == 7 else 7
        return n

    endless(0)
    return endless


def spoiled(cause, number):
    """Outputs of a toy that a fault has spoiled."""
    match cause:
        case "NaN":
            return {"out.number": np.full_like(number, np.nan)}
        case "wrong shape":
            return {"out.number": np.zeros((2, 3))}
        case "impulse of wrong shape":
            return {"out.push": np.ones((1, 3))}
        case "complex":
            return {"out.number": number + 1j}
        case "None":
            return {"out.push": None}
        case "huge":  # 6 GB, none of it in memory
            return {"out.number": np.broadcast_to(0.0, (250_000_000, 3))}
    return {}


class Faulty(Toy):
    """Fails by the given cause, the first few times that it reaches the given moment."""

    @parameters
    class Params:
        items: Count = 5
        pause: float = 0.0
        substeps: Count = 1
        seen: bool = False
        talks: bool = False
        fails_in: Moment = "step"
        fails_at: int = -1  # step
        fails_by: Cause = "exception"
        moment: str = ""  # file for the times of the failures
        times: Count = 1000  # a trial window that fails is no failure of the run
        differs: bool = False  # whether it steps differently after the first failure
        child: bool = False  # whether it has a child process, in a session of its own
        orphan: bool = False  # whether it has started a process whose parent has ended

    def __init__(self, params):
        super().__init__(params)
        self.odd = ""  # the fault of its outputs
        self.since_save = 0  # steps
        self.other = params.differs and Path(params.moment).is_file()
        loops = {"compiled loop": True, "locked loop": False}
        cause = params.fails_by
        self.endless = compiled(loops[cause]) if cause in loops else None
        if params.child:
            subprocess.Popen([sys.executable, "-c", OUTLIVES])
        if params.orphan:
            subprocess.run([sys.executable, "-c", ORPHANED], check=True)
        self.come_to("build")

    def come_to(self, moment, condition=True):
        """Fail if the parameters ask for a failure at this moment."""
        if moment == self.params.fails_in and condition and due(self.params):
            self.odd = self.params.fails_by
            fail(self.params.fails_by, self.endless)

    def after(self):
        """Whether the step was the last one."""
        return self.steps == self.params.fails_at + 1

    def fail(self):  # called in a step
        self.come_to("step")

    def step(self, dt):
        super().step(dt)
        self.since_save += 1
        self.come_to("later", self.since_save > self.params.fails_at)
        if self.other:
            self.value = self.value + 1e-12

    def give(self, wanted):
        if self.params.fails_in == "between" and self.after() and due(self.params):
            threading.Timer(SOON, fail, [self.params.fails_by]).start()
        self.come_to("give", self.after())
        return super().give(wanted) | spoiled(self.odd, self.value)

    def save(self):
        self.come_to("save", self.after())
        self.since_save = 0
        return super().save()

    def final_warnings(self):
        self.come_to("finish")
        return None if self.odd == "None" else {}
