"""Fixtures of the tests of faults: a scene with a component that fails as its parameters ask."""

import shutil

import pytest
from started import TOYS, Started, write_scene


@pytest.fixture
def faulty(tmp_path):
    """Start a scene whose second component is of a class of toy_faults.py or toy_waits.py."""
    started = []

    def start(kind, transport, pong, top="", end=0.1):
        for name in ("toy_faults.py", "toy_waits.py"):
            shutil.copy(TOYS.with_name(name), tmp_path)
        scene = write_scene(tmp_path, transport, end, pong=pong)
        text = f"{top}\n{scene.read_text()}"
        module = "toy_faults" if kind == "Faulty" else "toy_waits"
        scene.write_text(f"{module}:{kind}".join(text.rsplit("toys:Toy", 1)))
        started.append(Started(scene))
        return started[-1]

    yield start
    for run in started:
        run.end()
        run.process.communicate()
