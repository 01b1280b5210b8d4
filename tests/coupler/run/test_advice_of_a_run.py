"""A run reports the measured times that components waited for each other."""

import pytest
from started import write_scene

import quintet
from quintet.coupler.report.show import results


@pytest.mark.zenoh
def test_the_fast_one_waits_for_the_slow_one(tmp_path):
    scene = write_scene(tmp_path, "zenoh", 0.02, ping="pause = 0.01")
    quintet.run(str(scene), settings={"scheme": "parallel"}, out=tmp_path / "out")
    advice = results(tmp_path / "out")["advice"]
    slow = advice["components"]["ping"]["seconds"]
    assert slow > 0.2 and advice["seconds"] == slow
    assert advice["waits"]["pong"]["ping"] == pytest.approx(
        slow - advice["components"]["pong"]["seconds"]
    )
    assert "ping" not in advice["waits"], "nobody keeps it waiting"
