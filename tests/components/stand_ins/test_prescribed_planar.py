"""Bodies on given paths in two dimensions: their samples, and mistakes."""

import math

import numpy as np
import pytest

from quintet.components.stand_ins.params import PrescribedParams, prescribed_ports
from quintet.components.stand_ins.prescribed import Prescribed
from quintet.interfaces.params import read
from quintet.interfaces.ports import PLANAR_MOTION

DISC_BODY = {"shape": "disc", "centre": [0.0, 0.0, 0.0], "radius": 0.1}
WEDGE = {
    "shape": "polygon",
    "corners": [[0.0, 0.0], [0.0, 0.2], [0.3, 0.0]],  # the other way round: it is turned
    "origin": [1.0, 0.0, 0.0],
}
BOX = {"shape": "box", "lowest": [2.0, 0.0, 0.0], "highest": [2.1, 0.1, 0.1]}


def read_bodies(*bodies):
    return read(PrescribedParams, {"bodies": list(bodies)}, "paddle")


def test_discs_and_polygons_are_sampled_in_their_plane():
    params, mistakes = read_bodies(DISC_BODY, WEDGE)
    assert not mistakes and prescribed_ports(params)[1] == (PLANAR_MOTION,)
    settings = {"spacing": 0.02, "depth": 1.0, "inset": 0.01, "mirror": 1.0, "dimensions": 2.0}
    request = {f"motion.{name}": np.array([value]) for name, value in settings.items()}
    samples = Prescribed(params).sample(request)
    body, arm = samples["motion.body"].astype(int), samples["motion.arm"]
    area = np.bincount(body, samples["motion.volume"])
    np.testing.assert_allclose(area, [math.pi * 0.01, 0.03], rtol=1e-9)
    assert samples["motion.image"].shape == arm.shape
    wedge = arm[body == 1]  # about its position, a corner, not its centre of mass
    assert wedge[:, 0].min() > 0.0 and wedge[:, 2].min() > 0.0


@pytest.mark.parametrize(
    ("bodies", "sentence"),
    [
        ((DISC_BODY, BOX), "bodies[1].shape must have as many dimensions as those of"),
        ((BOX, WEDGE), "bodies[1].shape must have as many dimensions as those of"),
        (({**WEDGE, "radius": 1.0},), "a polygon is described by corners alone"),
        (({"shape": "box"},), "a box is described by lowest and highest alone; found none"),
        (({**WEDGE, "corners": [[0, 0], [1, 0]]},), "must go once round a polygon"),
        (({**DISC_BODY, "velocity": [0, 1, 0]},), "must move in the plane of x and z"),
        (({**DISC_BODY, "angular_velocity": [1, 0, 0]},), "must move in the plane of x and z"),
    ],
)
def test_mistakes_are_told(bodies, sentence):
    assert sentence in " ".join(read_bodies(*bodies)[1])
