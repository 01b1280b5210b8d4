"""A SLURM of this machine's own, for tests: two nodes of two cores, of whoever runs the tests."""

import contextlib
import getpass
import os
import shutil
import socket
import subprocess
import time

SBIN = os.pathsep.join([os.environ.get("PATH", ""), "/usr/sbin", "/sbin"])
NEEDED = ("munged", "slurmctld", "slurmd", "sbatch", "srun", "scontrol", "squeue", "scancel")
READY = 60.0  # s
CONF = """
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.sock
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
KillWait=10
SlurmctldPort={ports[0]}
NodeName=n1 NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[1]} CPUs=2 State=UNKNOWN
NodeName=n2 NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[2]} CPUs=2 State=UNKNOWN
PartitionName=all Nodes=n[1-2] Default=YES MaxTime=INFINITE State=UP
"""


def lacking():
    """Programs that are not installed."""
    return [name for name in NEEDED if shutil.which(name, path=SBIN) is None]


def free_ports(count):
    with contextlib.ExitStack() as stack:
        probes = [stack.enter_context(socket.socket()) for _ in range(count)]
        for probe in probes:
            probe.bind(("127.0.0.1", 0))
        return [probe.getsockname()[1] for probe in probes]


class Cluster:
    """Daemons in the foreground, and the jobs of tests."""

    def __init__(self, folder):
        self.folder = folder
        (folder / "state").mkdir()
        conf = folder / "slurm.conf"
        host = socket.gethostname().split(".")[0]
        user = getpass.getuser()
        conf.write_text(CONF.format(folder=folder, host=host, user=user, ports=free_ports(3)))
        self.env = {**os.environ, "SLURM_CONF": str(conf), "PATH": SBIN}
        key = folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        names = {"key-file": "key", "socket": "sock", "pid-file": "pid", "log-file": "log"}
        files = [f"--{option}={folder / 'munge'}.{end}" for option, end in names.items()]
        self.daemons = []
        # Only root may give the second node another name of its host.
        rename = ("unshare", "--uts", "sh", "-c", 'hostname n2 && exec "$@"', "sh")
        self.other_host = rename if os.geteuid() == 0 and shutil.which("unshare") else ()
        self._start("munged", "--foreground", "--force", f"--seed-file={folder}/seed", *files)
        self._await(lambda: (folder / "munge.sock").exists())
        self._start("slurmctld", "-D")
        self._start("slurmd", "-D", "-N", "n1")
        self._start(*self.other_host, "slurmd", "-D", "-N", "n2")
        self._await(lambda: self.call("sinfo", "-h", "-t", "idle", "-o", "%D").strip() == "2")

    def _start(self, *command):
        log = open(self.folder / f"daemon-{len(self.daemons)}.out", "wb")
        self.daemons.append(
            subprocess.Popen(command, env=self.env, stdout=log, stderr=log, cwd=self.folder)
        )
        log.close()

    @staticmethod
    def _await(ready):
        limit = time.monotonic() + READY
        while not ready():
            assert time.monotonic() < limit, "SLURM did not become ready"
            time.sleep(0.2)

    def call(self, *command, cwd=None):
        """Output of a command."""
        result = subprocess.run(command, env=self.env, cwd=cwd, capture_output=True, text=True)
        return result.stdout + result.stderr

    def jobs(self):
        """Numbers of the jobs that wait or run."""
        return self.call("squeue", "-h", "-o", "%i").split()

    def wait(self, seconds):
        """Wait until no job is left."""
        limit = time.monotonic() + seconds
        while self.jobs():
            assert time.monotonic() < limit, self.call("squeue")
            time.sleep(0.5)

    def close(self):
        """End all jobs, then the daemons."""
        for job in self.jobs():
            self.call("scancel", job)
        self.wait(60.0)
        for daemon in reversed(self.daemons):
            daemon.terminate()
            daemon.wait(20.0)
