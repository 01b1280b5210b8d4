"""A chain of masses of which one rank fails on purpose."""

import ctypes
import os
import signal
import sys
import time
from typing import Literal

import numpy as np
from toy_ranks import Chain

from quintet.interfaces.params import Count, parameters

LOCK = ctypes.create_string_buffer(64)  # a mutex of the C library


class FaultyChain(Chain):
    """Fails on one rank, as it is built or in a step."""

    @parameters
    class Params:
        items: Count = 7
        pause: float = 0.0
        fails_on: int = -1  # rank
        fails_at: int = -1  # step; -1: as it is built
        fails_by: Literal[
            "exception", "sys.exit", "os._exit", "SIGKILL", "SIGSTOP", "endless loop", "deadlock",
            "NaN",
        ] = "exception"  # fmt: skip
        moment: str = ""  # file for the time of the failure

    def __init__(self, params, resources):
        super().__init__(params, resources)
        self.spoils = False  # whether its rank returns a number that is none
        if params.fails_at < 0 and self.rank == params.fails_on:
            self.fail()

    def step(self, dt):
        if self.rank == self.params.fails_on and self.steps == self.params.fails_at:
            self.fail()
        super().step(dt)

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
            case "SIGSTOP":
                os.kill(os.getpid(), signal.SIGSTOP)
            case "endless loop":
                while True:
                    pass
            case "deadlock":
                libc = ctypes.PyDLL(None)  # which holds the interpreter's lock
                libc.pthread_mutex_lock(LOCK)
                libc.pthread_mutex_lock(LOCK)
            case "NaN":
                self.spoils = True

    def give(self, wanted):
        position = self.position
        if self.spoils:
            self.position = np.full_like(position, np.nan)
        fields = super().give(wanted)
        self.position = position
        return fields
