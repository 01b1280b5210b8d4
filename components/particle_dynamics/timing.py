"""Processor time of whole steps of lattices, without damping and with it, of one thread.

    python -m quintet.components.particle_dynamics.timing

Outputs are left out: `quintet bench` asks for all of them.
"""

import time
from typing import Any

from quintet.components.particle_dynamics.bench import lattice, pairs
from quintet.components.particle_dynamics.component import ParticleDynamics
from quintet.interfaces.params import read

SIZES = (10, 4, 4), (60, 20, 20), (98, 32, 32)
WORK = 5_000_000  # pairs of a measurement, and of a warm-up


def milliseconds(table: dict[str, Any], steps: int) -> float:
    """Mean processor time [ms] of a step, after as many that are not counted."""
    params, mistakes = read(ParticleDynamics.Params, table, "points")
    assert not mistakes, mistakes
    points = ParticleDynamics(params)
    for _ in range(2):
        begin = time.process_time()
        for _ in range(steps):
            points.step(points.stable_dt())
        spent = time.process_time() - begin
    return 1e3 * spent / steps


def main() -> None:
    """Print a line of each size."""
    for size in SIZES:
        damped, number = lattice(*size), pairs(*size)
        free = {key: value for key, value in damped.items() if key != "damping"}
        told = []
        for name, table in (("no damping", free), ("with damping", damped)):
            spent = milliseconds(table, max(20, WORK // number))
            told.append(f"{name} {spent:.3g} ms ({1e-3 * number / spent:.0f} M pairs/s)")
        print(f"{size[0] * size[1] * size[2]} points: {'; '.join(told)}", flush=True)


if __name__ == "__main__":
    main()
