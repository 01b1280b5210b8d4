"""Fixtures for tests of several folders: certificates, and programs on MPI ranks."""

import subprocess
import sys
from pathlib import Path

import pytest

from quintet.interfaces.lines.endpoint import Security


def openssl(folder, *arguments):
    subprocess.run(["openssl", *arguments], cwd=folder, check=True, capture_output=True)


def authority(folder, name):
    """Create an authority and a certificate for both sides that it signed; return their files."""
    key = ["-newkey", "rsa:2048", "-nodes", "-days", "1"]
    openssl(
        folder, "req", "-x509", *key, "-keyout", f"{name}.key", "-out", f"{name}.pem",
        "-subj", f"/CN={name}",
    )  # fmt: skip
    openssl(
        folder, "req", *key[:3], "-keyout", f"{name}-leaf.key", "-out", f"{name}-leaf.csr",
        "-subj", "/CN=quintet",
    )  # fmt: skip
    (folder / "leaf.ext").write_text(
        "subjectAltName=DNS:localhost,IP:127.0.0.1\nextendedKeyUsage=serverAuth,clientAuth\n"
    )
    openssl(
        folder, "x509", "-req", "-in", f"{name}-leaf.csr", "-CA", f"{name}.pem",
        "-CAkey", f"{name}.key", "-CAcreateserial", "-days", "1", "-extfile", "leaf.ext",
        "-out", f"{name}-leaf.pem",
    )  # fmt: skip
    files = [folder / f"{name}.pem", folder / f"{name}-leaf.pem", folder / f"{name}-leaf.key"]
    return Security(*map(str, files))


@pytest.fixture(scope="session")
def certificates(tmp_path_factory):
    """Files for mutual TLS on this host, signed by our authority and by a foreign one."""
    folder = tmp_path_factory.mktemp("certificates")
    return authority(folder, "ours"), authority(folder, "foreign")


@pytest.fixture(scope="session")
def on_ranks():
    """Run a Python program on several MPI ranks, with a deadline; return what it printed."""
    mpiexec = Path(sys.executable).with_name("mpiexec")
    launcher = str(mpiexec) if mpiexec.exists() else "mpiexec"

    def run(program, ranks, *arguments, seconds=100):
        command = [launcher, "-n", str(ranks), sys.executable, "-m", "mpi4py", str(program)]
        process = subprocess.run(
            [*command, *map(str, arguments)], timeout=seconds, capture_output=True, text=True
        )
        assert process.returncode == 0, process.stdout + process.stderr
        return process.stdout

    return run
