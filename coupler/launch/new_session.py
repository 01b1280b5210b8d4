"""Run a program in a session of its own: ``python -m ...launch.new_session JOB_FILE PROGRAM``.

An MPI launcher kills the process groups of all its ranks when one is killed, whatever its options.
The coupler, in a session of its own, survives to report it. If the coupler itself is killed, the
signal is written into the job's file, for the process that started the job.
"""

import contextlib
import json
import os
import subprocess
import sys
from pathlib import Path

job_file, *program = sys.argv[1:]
# Files that the launcher opened must stay open: MPI is initialized through them.
status = subprocess.call(program, start_new_session=True, close_fds=False)
if status < 0:
    with contextlib.suppress(OSError, ValueError):
        path = Path(job_file)
        part = path.with_suffix(".part")
        part.write_text(json.dumps({**json.loads(path.read_text()), "killed": -status}))
        part.replace(path)
    os.kill(os.getpid(), -status)  # so that the launcher sees how it ended
sys.exit(status)
