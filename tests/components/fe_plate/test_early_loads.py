"""Gauges of nodes that contact pushes tell the velocity of the present time."""

import json

import numpy as np
import pytest
from pydantic import TypeAdapter

from quintet.components.fe_plate.component import FePlate
from quintet.components.fe_plate.params import FePlateParams

SOFT = {"density": 1000.0, "youngs_modulus": 1e-3, "poissons_ratio": 0.0}
PUSH, DT = 2.0, 0.01  # N on each node, s


@pytest.mark.parametrize("port", ["node_load", "contact_surface"])
def test_a_steady_push_accelerates_the_gauges_as_the_motion(port):
    part = {"lowest": [0.0] * 3, "highest": [1.0] * 3, "elements": [1, 1, 1], "material": SOFT}
    gauges = {"node_gauges": [[0.0] * 3], "part_gauge": True}
    block = FePlate(
        TypeAdapter(FePlateParams).validate_json(json.dumps({"parts": [part], "gauges": gauges}))
    )
    block.bind({}, frozenset({"node_load", port}))
    for count in range(1, 4):
        block.take({"node_load.force": np.full((8, 3), PUSH)})
        block.step(DT)
        readings = block.give(frozenset({"node_gauge.velocity", "part_gauge.velocity"}))
        # Contact's forces act from a step's begin on: of the next one half is in it already.
        steps = count + 0.5 * (port == "contact_surface")
        if count == 1:  # what the judge took down at the start has this half too
            early = 0.5 * DT * PUSH / 125.0 * (port == "contact_surface")  # m/s along each axis
            assert block.judge.ranges[0, 1] == pytest.approx(0.5 * 1000.0 * 3.0 * early**2)
        for velocity in readings.values():
            np.testing.assert_allclose(velocity, steps * DT * PUSH / 125.0, rtol=1e-3)
