"""Exact solutions, for the scenes that have one."""

import numpy as np

from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.component import Array


def states_at(params: MeshlessGasParams, positions: Array, time: float) -> Array:
    """States (n, 5) kg/m3, m/s, Pa of nodes (n, 3) m at a time [s], by the exact solution."""
    if params.vortex is not None:
        # Scenes without a vortex do not load it.
        from quintet.components.meshless_gas.exact.vortex import Drift, states

        assert params.initial is not None and params.box is not None
        vortex, stream = params.vortex, params.initial.primitive(params.gas)
        lengths = np.array(params.box.highest) - np.array(params.box.lowest)
        drift = Drift(
            vortex.centre, vortex.strength, vortex.radius, stream, lengths, params.gas.gamma
        )
        return states(drift, positions, time)
    # Scenes without a diaphragm do not load it.
    from quintet.components.meshless_gas.exact.riemann import Side, solution

    assert params.riemann is not None
    left, right = (
        Side(*(side.primitive(params.gas)[k] for k in (0, 1, 4)))
        for side in (params.riemann.left, params.riemann.right)
    )
    x = positions[:, 0] - params.riemann.position
    exact = np.zeros((len(positions), 5))
    if time > 0.0:
        exact[:, [0, 1, 4]] = solution(left, right, params.gas.gamma, x / time)
    else:
        exact[:, [0, 1, 4]] = np.where((x < 0.0)[:, None], left, right)
    return exact
