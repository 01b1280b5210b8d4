"""A process beside this one that goes on once this one is gone, however it ended.

A process that is killed says nothing and cleans nothing up. Its companion is forked before
libraries start threads, polls its parent, and needs nothing that the parent's threads may hold.
"""

import contextlib
import os
import signal
import sys
import time
import warnings
from collections.abc import Callable
from typing import NoReturn

from quintet.coupler.launch.signal_handler import ENDING

INTERVAL = 0.1  # s between two polls of the parent


class Companion:
    """The companion of this process.

    Parameters
    ----------
    act : function
        Called in the companion with the number of this process; the companion ends with it.
    """

    def __init__(self, act: Callable[[int], object]) -> None:
        parent = os.getpid()
        signal.pthread_sigmask(signal.SIG_BLOCK, ENDING)
        try:
            with warnings.catch_warnings():
                # Of threads, as those of OpenBLAS: the companion uses none of what they may hold.
                warnings.simplefilter("ignore", DeprecationWarning)
                self._pid = os.fork()
            if not self._pid:
                _act_and_leave(parent, act)
        finally:  # also where no process can be started
            signal.pthread_sigmask(signal.SIG_UNBLOCK, ENDING)

    def close(self) -> None:
        """End the companion; a second call does nothing."""
        if not self._pid:
            return
        with contextlib.suppress(ProcessLookupError, ChildProcessError):
            os.kill(self._pid, signal.SIGKILL)
            os.waitpid(self._pid, 0)
        self._pid = 0


def once_gone(act: Callable[[], object]) -> Callable[[int], None]:
    """Return what a companion does that acts once its parent is gone."""

    def wait_and_act(parent: int) -> None:
        while os.getppid() == parent:
            time.sleep(INTERVAL)
        act()

    return wait_and_act


def _act_and_leave(parent: int, act: Callable[[int], object]) -> NoReturn:
    try:
        os.setsid()  # what ends the parent's session or process group must not end this
        signal.set_wakeup_fd(-1)
        for number in ENDING:
            signal.signal(number, signal.SIG_IGN)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, ENDING)
        act(parent)
        sys.stdout.flush()
        sys.stderr.flush()
    finally:
        os._exit(0)
