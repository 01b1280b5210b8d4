"""Run a program in a session of its own: ``python -m quintet.coupler.launch.new_session PROGRAM``.

An MPI launcher kills the process groups of all its ranks when one is killed, told not to or
not. The coupler, in a session of its own, lives to report it.
"""

import os
import subprocess
import sys

# What the launcher opened for the program must stay open: MPI begins through it.
status = subprocess.call(sys.argv[1:], start_new_session=True, close_fds=False)
if status < 0:
    os.kill(os.getpid(), -status)  # that the launcher sees how it ended
sys.exit(status)
