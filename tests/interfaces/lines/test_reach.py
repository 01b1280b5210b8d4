"""A failed connection names its cause within seconds."""

import socket
import subprocess
import threading
import time
from dataclasses import replace

import pytest

from quintet.interfaces.errors import LineError
from quintet.interfaces.lines.endpoint import free_port
from quintet.interfaces.lines.reach import obstacle
from quintet.interfaces.lines.zenoh import Session, connect

pytestmark = pytest.mark.zenoh
SOON = 5.0  # s


@pytest.fixture
def listen():
    opened = []

    def start(security, host="localhost"):
        protocol = "tls" if security else "tcp"
        port = free_port()
        opened.append(Session(f"{protocol}/{host}:{port}", True, "coupler", security))
        return port

    yield start
    for session in opened:
        session.close()


@pytest.fixture
def program():
    """A program that is no run: it answers everybody with the same bytes."""
    server = socket.create_server(("127.0.0.1", 0))

    def answer(reply):
        def serve():
            while True:
                try:
                    link, _ = server.accept()
                except OSError:
                    return
                links.append(link)
                if reply:
                    link.sendall(reply)

        threading.Thread(target=serve, daemon=True).start()
        return server.getsockname()[1]

    links = []
    yield answer
    server.close()
    for link in links:
        link.close()


def leaf(folder, authority, name, names, *options):
    """A certificate for some names, signed by an authority of the tests."""
    (folder / "leaf.ext").write_text(
        f"subjectAltName={names}\nextendedKeyUsage=serverAuth,clientAuth\n"
    )
    key = authority.authority.replace(".pem", ".key")
    for command in (
        ["req", "-newkey", "rsa:2048", "-nodes", "-keyout", f"{name}.key", "-out", f"{name}.csr",
         "-subj", "/CN=quintet"],
        ["x509", "-req", "-in", f"{name}.csr", "-CA", authority.authority, "-CAkey", key,
         "-CAcreateserial", "-extfile", "leaf.ext", "-out", f"{name}.pem", *options],
    ):  # fmt: skip
        subprocess.run(["openssl", *command], cwd=folder, check=True, capture_output=True)
    files = {"certificate": f"{folder}/{name}.pem", "key": f"{folder}/{name}.key"}
    return replace(authority, **files)


def refusal(endpoint, security=None):
    """Join an endpoint; return the error's text, and check that it came soon."""
    began = time.monotonic()
    with pytest.raises(LineError) as error:
        connect(endpoint, "pong", security)
    assert time.monotonic() - began < SOON
    assert str(error.value).startswith(f"endpoint {endpoint}: pong cannot reach it: ")
    assert ".rs" not in str(error.value)
    return str(error.value)


def test_a_run_that_can_be_reached_has_nothing_in_the_way(listen, certificates):
    ours = certificates[0]
    assert obstacle(f"tcp/127.0.0.1:{listen(None)}", None).text == ""
    port = listen(ours)
    assert obstacle(f"tls/localhost:{port}", ours).text == ""
    assert obstacle(f"tls/127.0.0.1:{port}", ours).text == ""


def test_a_port_where_nobody_listens(certificates):
    for endpoint in (f"tcp/127.0.0.1:{free_port()}", f"tls/localhost:{free_port()}"):
        message = refusal(endpoint, certificates[0])
        assert "nobody listens on port" in message and "has not begun, or it has ended" in message


def test_plain_tcp_where_the_run_uses_tls(listen, certificates):
    port = listen(certificates[0])
    assert "listens with tls; a plain connection" in refusal(f"tcp/localhost:{port}")


def test_tls_where_the_run_uses_plain_tcp(listen, certificates):
    message = refusal(f"tls/127.0.0.1:{listen(None)}", certificates[0])
    assert "listens with plain tcp; tls was tried" in message


def test_a_run_whose_certificate_is_of_another_authority(listen, certificates):
    ours, foreign = certificates
    message = refusal(f"tls/localhost:{listen(ours)}", foreign)
    assert f"not signed by the authority {foreign.authority}" in message


def test_a_certificate_that_the_run_refuses(listen, certificates):
    ours, foreign = certificates
    mixed = replace(foreign, authority=ours.authority)
    message = refusal(f"tls/localhost:{listen(ours)}", mixed)
    assert (
        f"refuses the certificate {foreign.certificate}: its authority did not sign it" in message
    )


def test_a_certificate_for_another_host(listen, certificates, tmp_path):
    certificate = leaf(tmp_path, certificates[0], "other", "DNS:other.example", "-days", "1")
    message = refusal(f"tls/localhost:{listen(certificate)}", certificates[0])
    assert "not valid for localhost. Its subjectAltName must have the host" in message


def test_a_certificate_that_has_expired(listen, certificates, tmp_path):
    names = "DNS:localhost,IP:127.0.0.1"
    past = ("-days", "-1")
    old = leaf(tmp_path, certificates[0], "old", names, *past)
    assert "has expired. Renew it" in refusal(f"tls/localhost:{listen(old)}", certificates[0])
    message = refusal(f"tls/localhost:{listen(certificates[0])}", old)
    assert "old.pem: it has expired" in message


def test_files_that_are_no_certificates(listen, certificates, tmp_path):
    (tmp_path / "none.pem").write_text("nothing")
    wrong = replace(certificates[0], certificate=str(tmp_path / "none.pem"))
    message = refusal(f"tls/localhost:{listen(certificates[0])}", wrong)
    assert "must be an authority, a certificate and its key" in message
    mismatched = replace(certificates[0], key=certificates[1].key)
    message = refusal(f"tls/localhost:{listen(certificates[0])}", mismatched)
    assert "must be an authority, a certificate and its key" in message


def test_another_program_at_the_port(program):
    message = refusal(f"tcp/127.0.0.1:{program(b'HTTP/1.1 400 Bad Request')}")
    assert "what listens there is no run of quintet (it answers b'HTTP/1.1 400" in message


@pytest.mark.slow
def test_another_program_that_is_silent(program):
    port = program(b"")
    began = time.monotonic()
    with pytest.raises(LineError, match="does not answer as a run of quintet does"):
        connect(f"tcp/127.0.0.1:{port}", "pong")
    assert time.monotonic() - began < 10.0
