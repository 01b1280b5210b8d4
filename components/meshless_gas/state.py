"""All arrays of a gas that change, and the numbers of its scheme."""

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.thread_grain import WHOLESALE
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array, Fields


@dataclass(slots=True)
class State:
    """What is remembered from one step to the next; n nodes, ghosts left out."""

    conservative: Array  # (n, 5) kg/m3, kg/(m2 s), J/m3
    primitive: Array  # (n, 5) kg/m3, m/s, Pa, in the laboratory's frame
    entered: Array  # (5,) kg, N s, J, through the boundary since the start
    begun: Array  # (5,) kg, N s, J, at the start
    time: float = 0.0  # s
    work: float = 0.0  # J, energy that came in since the start but for what partners brought
    change: float = 0.0  # 1, root mean square of the densities' relative change in the last step

    def save(self) -> dict[str, NDArray[Any]]:
        """Copy out everything."""
        return {part.name: np.array(getattr(self, part.name)) for part in fields(self)}

    def load(self, saved: Fields) -> None:
        """Come back to a saved state, in the same arrays; a rank may hold some of its rows."""
        for name in ("conservative", "primitive", "entered", "begun"):
            getattr(self, name)[:] = saved[name]
        for name in ("time", "work", "change"):
            setattr(self, name, float(saved[name]))


def conserved(conservative: Array, volumes: Array, team: Team) -> Array:
    """Mass, momentum and energy (5,) kg, N s, J of all nodes, by sums of one order.

    Those of a product of matrices would depend on the threads of the library that computes it.
    """
    sums = np.empty(5)

    def add(first: int, last: int) -> None:
        for q in range(first, last):
            sums[q] = (volumes[: len(conservative)] * conservative[:, q]).sum()

    team.run(add, 5, fewest=1 if len(conservative) > WHOLESALE else 5)
    return sums


@dataclass(slots=True)
class Fluxes:
    """What a stage computes from the states of nodes, m with their ghosts."""

    primitive: Array  # (m, 5), of nodes and ghosts
    gradients: Array  # (m, 5, 3)
    lowest: Array  # (m,) Pa, least pressure of a node and its neighbours
    residual: Array  # (n, 5) kg/(m3 s), N/m3, W/m3
    start: Array  # (n, 5), conservative, at the step's start
    sound: Array  # (m,) m/s
    bounds: Array  # (n,) s, stable steps of nodes at a Courant number of 1
    steps: Array  # (n,) 1, steps of nodes over the shortest
    changes: Array  # (n,) 1, squares of relative changes of densities
    flows: Array  # (5,) kg/s, N, W, through the boundary

    @classmethod
    def empty(
        cls, nodes: int, ghosts: int, room: Callable[[tuple[int, ...]], Array] = np.zeros
    ) -> "Fluxes":
        """Make room; `room` makes arrays of a shape of which a rank may write a part alone."""
        whole = nodes + ghosts
        return cls(
            primitive=np.zeros((whole, 5)),
            gradients=room((whole, 5, 3)),
            lowest=np.zeros(whole),
            residual=room((nodes, 5)),
            start=room((nodes, 5)),
            sound=np.ones(whole),
            bounds=np.ones(nodes),
            steps=np.ones(nodes),
            changes=np.zeros(nodes),
            flows=np.zeros(5),
        )
