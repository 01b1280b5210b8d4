"""Components whose process dies at a moment, the first few times that it comes to it."""

import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Literal

import numpy as np
from toy_ranks import Chain
from toys import Toy

from quintet.interfaces.params import Count, parameters

SOON = 1e-3  # s after an answer, while the partner still steps
SLEEPS = "import time; time.sleep(602)"
Cause = Literal["SIGKILL", "os._exit", "SIGSTOP", "exception", "NaN"]
Moment = Literal["never", "build", "step", "between", "save", "later", "end"]


def dies(params):
    """Whether to die now: as often as is asked for, counted in a file."""
    path = Path(params.deaths)
    count = path.stat().st_size if path.is_file() else 0
    if count < params.times:
        with open(path, "ab") as file:
            file.write(b"x")
    return count < params.times


def die(params):
    """Die, as is asked for."""
    match params.dies_by:
        case "SIGKILL":
            os.kill(os.getpid(), signal.SIGKILL)
        case "SIGSTOP":
            os.kill(os.getpid(), signal.SIGSTOP)
        case "os._exit":
            os._exit(0)
        case "exception":
            raise ArithmeticError("asked to raise")


class Mortal(Toy):
    """Dies in its process."""

    @parameters
    class Params:
        items: Count = 5
        pause: float = 0.0
        substeps: Count = 1
        seen: bool = False
        talks: bool = False
        fails_at: int = -1
        fails_by: str = ""
        deaths: str = ""  # file that counts them
        times: int = 1
        dies_in: Moment = "never"
        dies_at: int = 0  # step, or steps since it was saved
        dies_by: Cause = "SIGKILL"
        child: bool = False  # whether it starts a process in a session of its own
        differs: bool = False  # whether it steps differently after the first death

    def __init__(self, params):
        super().__init__(params)
        if params.dies_in == "build" and dies(params):
            die(params)
        if params.child:
            subprocess.Popen([sys.executable, "-c", SLEEPS], start_new_session=True)
        self.since_save = 0  # steps
        self.other = params.differs and Path(params.deaths).is_file()

    def step(self, dt):
        super().step(dt)
        self.since_save += 1
        if self.params.dies_in == "later" and self.since_save > self.params.dies_at:
            if dies(self.params):
                die(self.params)
        if self.other:
            self.value = self.value + 1e-12
        if self.params.dies_in == "step" and self.steps == self.params.dies_at + 1:
            if dies(self.params):
                die(self.params)
                self.value = np.full_like(self.value, np.nan)  # that is the cause if it lives

    def give(self, wanted):
        if self.params.dies_in == "between" and self.steps == self.params.dies_at + 1:
            if dies(self.params):
                threading.Timer(SOON, die, [self.params]).start()
        return super().give(wanted)

    def save(self):
        if self.params.dies_in == "save" and self.steps == self.params.dies_at + 1:
            if dies(self.params):
                die(self.params)
        self.since_save = 0
        return super().save()

    def final_warnings(self):
        if self.params.dies_in == "end" and dies(self.params):
            die(self.params)
        return {}


class MortalChain(Chain):
    """Dies on rank 1."""

    @parameters
    class Params:
        items: Count = 7
        pause: float = 0.0
        deaths: str = ""
        times: int = 1
        dies_in: Moment = "never"
        dies_at: int = 0
        dies_by: Cause = "SIGKILL"

    def __init__(self, params, resources):
        super().__init__(params, resources)
        if self.rank == 1 and params.dies_in == "build" and dies(params):
            die(params)

    def step(self, dt):
        super().step(dt)
        if self.rank == 1 and self.params.dies_in == "step":
            if self.steps == self.params.dies_at + 1 and dies(self.params):
                time.sleep(SOON)  # rank 0 has gone on
                die(self.params)
