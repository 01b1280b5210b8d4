"""A plate whose upper layer erodes at a time that a scene sets, without any force."""

import numpy as np

from quintet.components.fe_plate.component import FePlate
from quintet.components.fe_plate.params import FePlateParams
from quintet.components.fe_plate.state import ACTIVE, LANES
from quintet.interfaces.params import NotNegative, Number, parameters


class Peeling(FePlate):
    """Elements of one point above a height are eroded once a time has come."""

    @parameters
    class Params(FePlateParams):
        """Parameters of the plate; which elements erode, and when."""

        above: Number = 0.0  # m, along z
        peeled: NotNegative = 0.0  # s

    def step(self, dt):
        """Erode the elements, then advance."""
        if self.accumulated.time >= self.params.peeled:
            # Of all places, those that repeat a part's last element included.
            middle = self.built.mesh.node[self.model.corner].mean(axis=1)
            blocks, lanes = np.divmod(np.flatnonzero(middle[:, 2] > self.params.above), LANES)
            self.state.points[blocks, ACTIVE, lanes] = 0.0
        super().step(dt)
