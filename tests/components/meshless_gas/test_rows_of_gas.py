"""A row has the same bits wherever it stands: threads and ranks cut rows anywhere."""

import numpy as np
import pytest

from quintet.components.meshless_gas.axis.kernels import add_axis, write_swelling
from quintet.components.meshless_gas.kernels.motion import write_sound
from quintet.components.meshless_gas.laws.transport import Transport
from quintet.components.meshless_gas.viscous.kernels.flux import write_transport

ROWS = 203
AIR = Transport(*np.linspace(1.0, 2.0, len(Transport._fields)).tolist())
random = np.random.default_rng(1)
STATE = random.uniform(0.5, 2.0, (ROWS, 5))
PLACES = random.uniform(0.5, 2.0, (ROWS, 3))
CASES = {
    write_sound: (STATE, 1.4, np.zeros(ROWS)),
    write_transport: (STATE, AIR, np.zeros((ROWS, 2))),
    write_swelling: (PLACES, STATE, STATE[:, :2].copy(), np.zeros(ROWS)),
    add_axis: (np.arange(ROWS), PLACES, STATE, 1.4, np.ones((ROWS, 5))),
}


@pytest.mark.parametrize("kernel", CASES, ids=lambda kernel: kernel.__name__)
def test_rows_have_the_same_bits_wherever_they_stand(kernel):
    *arguments, target = CASES[kernel]
    results = []
    for length in (ROWS, 1, 2, 3, 5, 7, 11):
        results.append(target.copy())
        for first in range(0, ROWS, length):
            kernel(first, min(first + length, ROWS), *arguments, results[-1])
    assert {result.tobytes() for result in results} == {results[0].tobytes()}
