"""A row has the same bits wherever it stands: threads and ranks cut rows anywhere."""

import numpy as np
from fluid_params import fluid_params

from quintet.components.sph_fluid.constants import constants
from quintet.components.sph_fluid.pairs.kernels import move_by, write_damped_pressure

ROWS = 203


def in_pieces(kernel, length, written, *arguments):
    """Call a kernel on pieces of its rows; return a changed copy of the written array."""
    copy = written.copy()
    for first in range(0, ROWS, length):
        rows = first, min(first + length, ROWS)
        kernel(*rows, *(copy if part is written else part for part in arguments))
    return copy


def check(kernel, written, *arguments):
    expected = in_pieces(kernel, ROWS, written, *arguments)
    for length in (1, 2, 3, 5, 7, 11):
        assert in_pieces(kernel, length, written, *arguments).tobytes() == expected.tobytes()


def test_rows_have_the_same_bits_wherever_they_stand():
    random = np.random.default_rng(1)
    box = ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    numbers = constants(fluid_params(spacing=0.1, sound_speed=40.0, fluid=[box]))
    position, velocity = random.uniform(0.5, 2.0, (2, ROWS, 4))
    position[:, 3] = 1000.0 + 5.0 * position[:, 3]
    compression = random.uniform(-1.0, 1.0, ROWS)
    check(write_damped_pressure, velocity, 0.9, compression, position, velocity, numbers)
    check(move_by, position, 1e-3, velocity, position)
