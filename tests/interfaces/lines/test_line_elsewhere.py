"""A line to another host, whose network may hold up a message for long."""

import time

import numpy as np
import pytest

pytest.importorskip("zenoh")

from quintet.interfaces.lines.frame_codes import FrameCodes
from quintet.interfaces.lines.line_elsewhere import ROOM, LineElsewhere
from quintet.interfaces.lines.transport import FramedLine


class HeldUp(LineElsewhere):
    """A line whose network takes no large message for a while."""

    def __init__(self, seconds):
        FramedLine.__init__(self, "run", "coupler")
        self.other, self.seconds, self.frames = "water", seconds, 0
        self._codes_out = FrameCodes("secret", "coupler", "water")

    def _publish(self, frame):
        time.sleep(self.seconds)
        self.frames += 1

    def _broken(self):
        return ""


@pytest.mark.zenoh
def test_a_message_is_not_sent_again_while_it_is_on_its_way():
    line = HeldUp(0.4)
    line.repeat_after = 0.05
    line.send({"order": "advance"}, {"x": np.zeros(ROOM)})
    assert line.frames == 1
    line._repeat()
    assert line.frames == 1, "its answer is awaited from now on"
