"""Memory of frames is used again, but never while an array of a message is a view of it."""

import numpy as np

from quintet.interfaces.lines.frame_buffers import KEPT, FrameBuffers
from quintet.interfaces.lines.message import decode, encode


def received(buffers, value):
    """A message that arrives in one of the buffers."""
    sent = encode({"order": "done"}, {"x": np.full(3, value)}, None)
    frame = buffers.take(len(sent))
    frame[:] = np.frombuffer(sent, np.uint8)
    return decode(frame).fields["x"]


def test_fields_that_are_kept_are_not_overwritten():
    buffers = FrameBuffers()
    fields = [received(buffers, float(value)) for value in range(3 * KEPT)]
    assert [field.tolist() for field in fields] == [3 * [float(n)] for n in range(3 * KEPT)]


def test_memory_that_nobody_needs_is_used_again():
    buffers = FrameBuffers()
    first = buffers.take(100)
    place = first.ctypes.data
    assert buffers.take(100).ctypes.data != place
    del first
    assert buffers.take(100).ctypes.data == place
    assert buffers.take(101).ctypes.data != place
