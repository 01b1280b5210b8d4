"""An answer that was only looked at, for a failure, is still to be received."""

import numpy as np

from quintet.coupler.coupling.participant import Participant
from quintet.interfaces.lines.memory import MemoryLine


def participant_with(header):
    """A participant whose last order has this answer, which nobody has received."""
    line = MemoryLine("run", "water")
    line.handle = lambda message: line.far.send(header, {"x": np.zeros(2)})
    participant = Participant("water", line)
    participant.send_order("view")
    return participant


def test_an_answer_that_was_looked_at_is_received_before_the_next_order():
    """In a trial that another component fails, all answers are awaited before it is undone."""
    participant = participant_with({"order": "done", "totals": {}})
    assert not participant.has_failed() and not participant.answered
    assert not participant.has_failed(), "it is looked at once"
    assert participant.line.receive(1.0).order == "done"


def test_a_failure_that_nobody_awaits_is_seen():
    participant = participant_with({"order": "failed"})
    assert participant.has_failed() and not participant.answered
