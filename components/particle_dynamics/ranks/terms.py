"""What the steps of a lattice need besides its points."""

from typing import Any, NamedTuple

from quintet.interfaces.component import Array


class Terms(NamedTuple):
    """Forces of pairs, and numbers of the step."""

    law: Any  # SevenRoots or ForceTable
    damping: Any  # PairDamping or None
    period: Array | None  # (6,) m and 1/m, lengths of periodic sides and inverses; None: open
    lowest: Array  # (3,) m, where periodic sides begin
    bonds: Array  # (b, 2) of all nearest points
    spacing: float  # m
    boltzmann: float  # J/K
    averaged_from: float  # s, from when kinetic energies are averaged
