"""Run a program in a session of its own: ``python -m quintet.coupler.launch.new_session PROGRAM``.

An MPI launcher kills the process groups of all its ranks when one is killed, whatever its options.
The coupler, in a session of its own, survives to report it.
"""

import os
import subprocess
import sys

# Files that the launcher opened must stay open: MPI is initialized through them.
status = subprocess.call(sys.argv[1:], start_new_session=True, close_fds=False)
if status < 0:
    os.kill(os.getpid(), -status)  # so that the launcher sees how it ended
sys.exit(status)
