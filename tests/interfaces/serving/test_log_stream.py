"""A log without room drops printed lines and ends no process."""

import subprocess
import sys

PRINTS = """
import os, resource, sys
from quintet.interfaces.serving.log_stream import print_into_logs
print_into_logs()
resource.setrlimit(resource.RLIMIT_FSIZE, (100, resource.RLIM_INFINITY))
for n in range(1000):
    print(f"line {n}", flush=True)
    print(f"to errors {n} \\udcff", file=sys.stderr)
"""


def test_what_finds_no_room_in_a_log_is_left_out(tmp_path):
    log = tmp_path / "log"
    with open(log, "wb") as file:
        status = subprocess.run([sys.executable, "-c", PRINTS], stdout=file, stderr=file).returncode
    assert status == 0
    assert log.stat().st_size == 100 and log.read_text().startswith("line 0\nto errors 0 \\udcff\n")
