"""A field that nobody wants is not given, not sent and not recorded."""

import h5py
import laboratory
import pytest
from toy_gauges import BINDINGS, REQUESTS

from quintet.coupler.run.simulate import make_folder, simulate
from quintet.coupler.scene.read import load
from quintet.interfaces.lines.transport import FramedLine

WINDOWS, STEPS = 5, 10


@pytest.fixture
def answer_sizes(monkeypatch):
    """Bytes of every answer, as they cross the line."""
    sizes = []
    send = FramedLine.send

    def send_and_count(line, header, fields):
        if header.get("order") == "done":
            sizes.append(sum(array.nbytes for array in fields.values()))
        send(line, header, fields)

    monkeypatch.setattr(FramedLine, "send", send_and_count)
    return sizes


def _run(folder, link=None, count=1000, **settings):
    components = {"gauged": {"kind": "toy_gauges:Gauged", "count": count}}
    if link:
        components["spring"] = {
            "kind": "quintet.scenarios.two_springs.springs:Mass",
            **{"mass": 1.0, "stiffness": 10.0, "arm": [0.0, 0.0, 1.0], "start": [0.0, 0.0, 1.0]},
        }
    path = laboratory.scene(folder, components, link or [], end=0.5, window=0.1, **settings)
    scene = load(str(path))
    run = folder / "run"
    make_folder(scene, run)
    assert simulate(scene, run) == 0
    with h5py.File(run / "recording.h5", locking=False) as file:
        recorded = {name: set(group["fields"]) for name, group in file["components"].items()}
    return recorded["gauged"]


def test_alone_it_gives_sends_and_records_nothing(tmp_path, answer_sizes):
    assert _run(tmp_path) == set()
    assert not REQUESTS and BINDINGS["joined"] == set()
    assert max(answer_sizes) == 0


def test_an_expectation_asks_for_one_field_at_windows_ends(tmp_path, answer_sizes):
    expected = {
        "name": "gauge", "component": "gauged", "field": "gauge.value", "measure": "max",
        "value": 0.0, "within": 0.0, "unit": "Pa", "source": "none",
    }  # fmt: skip
    assert _run(tmp_path, expect=[expected]) == {"gauge.value"}
    assert REQUESTS == {
        "gauge.value": 2 + WINDOWS
    }  # and at the start, before and after components are primed
    assert max(answer_sizes) == 8 * 1000


def test_a_link_asks_for_impulses_after_every_step(tmp_path, answer_sizes):
    link = {"kind": "direct", "pairs": [["gauged.push", "spring.load"]]}
    assert _run(tmp_path, [link], count=1) == {"push.force"}
    assert REQUESTS == {"push.force": 2 + WINDOWS * STEPS}
    assert BINDINGS["joined"] == {"push"}


def test_output_fields_are_recorded_though_no_link_reads_them(tmp_path, answer_sizes):
    output_fields = {"fields": ["gauged.motion.velocity"]}
    assert _run(tmp_path, output=output_fields) == {"motion.velocity"}
    assert REQUESTS == {"motion.velocity": 2 + WINDOWS}
    assert max(answer_sizes) == 3 * 8 * 1000
