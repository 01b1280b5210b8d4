"""A run over zenoh for which no endpoint is given finds a free port, though others are taken."""

import socket
from types import SimpleNamespace

import pytest

from quintet.coupler.launch import over_zenoh
from quintet.coupler.launch.over_zenoh import OverZenoh
from quintet.interfaces.errors import LineError, SceneError

pytestmark = pytest.mark.zenoh


@pytest.fixture
def run():
    """A run that is to listen where another program does, and the port of that."""
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        run = OverZenoh.__new__(OverZenoh)
        run.endpoint, run.several_hosts = f"tcp/127.0.0.1:{port}", False
        run.scene = SimpleNamespace(security=None, elsewhere=set(), endpoint="")
        yield run


def test_another_port_is_taken(run):
    before = run.endpoint
    session = run._listen_somewhere()
    session.close()
    assert run.endpoint != before


def test_an_endpoint_that_is_given_is_not_left(run):
    run.scene.endpoint = run.endpoint
    with pytest.raises(SceneError, match=r"Name another endpoint, or give none\."):
        run._listen_somewhere()


def test_after_some_ports_it_gives_up(run, monkeypatch):
    def refuse(*_):
        tried.append(run.endpoint)
        raise LineError("endpoint: it is taken")

    tried = []
    monkeypatch.setattr(over_zenoh, "Session", refuse)
    with pytest.raises(SceneError, match="it is taken"):
        run._listen_somewhere()
    assert len(set(tried)) == over_zenoh.PORTS_TRIED
