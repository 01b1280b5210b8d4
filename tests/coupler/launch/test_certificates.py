"""Certificates of a scene: made once, for the names of its components, readable by one user."""

import datetime
import os
import ssl

import pytest
from started import write_scene

from quintet.coupler.cli import main
from quintet.coupler.launch.certificates import hosts_of, write_certificates
from quintet.interfaces.errors import SceneError
from quintet.interfaces.lines.access import common_name

NAMES = ("authority", "coupler", "ping", "pong")


def run(*arguments):
    with pytest.raises(SystemExit) as exit_info:
        main(["certificates", *map(str, arguments)])
    return exit_info.value.code


@pytest.fixture
def scene(tmp_path):
    return write_scene(tmp_path, "zenoh")


def test_a_scene_gets_an_authority_and_a_certificate_for_each_name(scene, tmp_path, capsys):
    out = tmp_path / "tls"
    hosts = ("--hosts", "coupler=node1,10.0.0.1", "--hosts", "pong=node2.example.org")
    assert run(scene, "--out", out, *hosts, "--days", 30) == 0
    assert sorted(path.name for path in out.iterdir()) == sorted(
        f"{name}.{end}" for name in NAMES for end in ("pem", "key")
    )
    assert {path.stat().st_mode & 0o777 for path in out.iterdir()} == {0o600}
    assert [common_name(str(out / f"{name}.pem")) for name in NAMES] == list(NAMES)
    output = capsys.readouterr().out
    end = datetime.date.today() + datetime.timedelta(days=30)
    assert f"certificates for coupler, ping, pong, valid until {end} (30 days)" in output
    assert f"--tls {out}/authority.pem {out}/ping.pem {out}/ping.key" in output
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.load_verify_locations(out / "authority.pem")
    for name in NAMES[1:]:
        context.load_cert_chain(out / f"{name}.pem", out / f"{name}.key")
    certificate = ssl._ssl._test_decode_cert(str(out / "coupler.pem"))
    assert {("DNS", "localhost"), ("DNS", "node1"), ("IP Address", "10.0.0.1")} <= set(
        certificate["subjectAltName"]
    )


def test_no_file_is_replaced(scene, tmp_path, capsys):
    out = tmp_path / "tls"
    out.mkdir()
    (out / "pong.key").write_text("mine")
    assert run(scene, "--out", out) == 2
    assert f"certificates replaces no file; {out}/pong.key is there" in capsys.readouterr().err
    assert [path.name for path in out.iterdir()] == ["pong.key"]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("pang=node1", "NAME=HOST,HOST with a component of the scene or coupler; found 'pang=node"),
        ("pong", "NAME=HOST,HOST with a component of the scene or coupler; found 'pong'"),
        ("pong=", "NAME=HOST,HOST with a component of the scene or coupler; found 'pong='"),
        ("pong=a b", "a host must be a name or an IP address; found 'a b'"),
        ("pong=a,,b", "a host must be a name or an IP address; found ''"),
    ],
)
def test_hosts_that_cannot_be_are_refused(text, words):
    with pytest.raises(SceneError) as error:
        hosts_of([text], ["ping", "pong"], "")
    assert words in str(error.value)


def test_the_host_of_the_endpoint_is_one_of_the_coupler():
    assert "node7" in hosts_of([], ["pong"], "tls/node7:7447")["coupler"]


def test_the_name_of_this_host_may_have_an_underscore(monkeypatch):
    monkeypatch.setattr("socket.gethostname", lambda: "my_node")
    assert "my_node" in hosts_of([], ["pong"], "")["coupler"]


@pytest.mark.parametrize("days", ["0", "3651", "x", "-1"])
def test_validity_has_bounds(scene, tmp_path, capsys, days):
    assert run(scene, "--out", tmp_path / "tls", f"--days={days}") == 2
    assert "must be a whole number from 1 to 3650" in capsys.readouterr().err


def test_a_component_called_authority_is_refused(tmp_path):
    with pytest.raises(SceneError, match="Name the component otherwise"):
        write_certificates(tmp_path, {"authority": ["localhost"]}, 1)


def test_a_component_whose_name_is_too_long_for_a_certificate_is_refused(tmp_path):
    with pytest.raises(SceneError, match=r"components\.a{65}: .* at most 64 characters; found 65"):
        write_certificates(tmp_path / "tls", {"coupler": ["localhost"], 65 * "a": ["localhost"]}, 1)
    assert not (tmp_path / "tls").exists()


def test_certificates_that_cannot_all_be_written_leave_none(tmp_path, monkeypatch):
    def open_some(path, *more):
        if str(path).endswith("coupler.key"):
            raise OSError(28, "No space left on device")
        return system_open(path, *more)

    system_open = os.open
    monkeypatch.setattr(os, "open", open_some)
    with pytest.raises(SceneError, match="certificates must be written there; they cannot"):
        write_certificates(tmp_path, {"coupler": ["localhost"]}, 1)
    assert not list(tmp_path.iterdir())


def test_without_the_library_it_is_named(tmp_path, monkeypatch):
    monkeypatch.setattr("quintet.interfaces.libraries.find_spec", lambda name: None)
    with pytest.raises(SceneError, match=r"needs the library cryptography.*quintet\[zenoh\]"):
        write_certificates(tmp_path, {"coupler": ["localhost"]}, 1)
