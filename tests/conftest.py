"""What tests of several folders share."""

import subprocess

import pytest

from quintet.interfaces.lines.endpoint import Security


def openssl(folder, *arguments):
    subprocess.run(["openssl", *arguments], cwd=folder, check=True, capture_output=True)


def authority(folder, name):
    """An authority with its key, and a leaf for both sides that it signed."""
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
    """Files for mutual TLS on this host: of an authority of ours, and of a foreign one."""
    folder = tmp_path_factory.mktemp("certificates")
    return authority(folder, "ours"), authority(folder, "foreign")
