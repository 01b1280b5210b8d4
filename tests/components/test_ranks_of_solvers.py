"""Solvers on one to four MPI ranks: the same bits after many steps, and after restarts."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from rank_runs import MOVED, RANK_PROGRAM, differences

pytestmark = [pytest.mark.mpi, pytest.mark.full]
HERE = Path(__file__).parent
STEPS = 1000
WINDOWS, LATEST = 11, 80  # number of snapshots, upper bound of their steps
CASES = {
    "sph_fluid/fluid_on_ranks.py": ("dam", "symmetric", "body"),
    "sph_solid/solid_on_ranks.py": ("impact", "quarter", "glued"),
    "dem_bodies/dem_on_ranks.py": ("heap", "rolling", "boxes"),
    "fe_plate/structure_on_ranks.py": ("struck", "pressed", "bent", "glued", "plane"),
    "meshless_gas/gas_on_ranks.py": ("vortex", "tube"),
    "particle_dynamics/lattice_on_ranks.py": ("driven", "heated", "periodic", "breaks up"),
    "particle_dynamics/spheres_on_ranks.py": (
        *("gas", "pile", "too long steps", "row", "streams", "tethered", "parcels"),
    ),
}
SCENES = [(program, name) for program, names in CASES.items() for name in names]


@pytest.mark.parametrize(("program", "name"), SCENES)
def test_many_steps_give_the_same_bits_on_one_to_four_ranks(program, name, tmp_path, on_ranks):
    def run(ranks, *options):
        arguments = (HERE / program, tmp_path, STEPS, 0, name, *options)
        on_ranks(RANK_PROGRAM, ranks, *arguments, seconds=3000)
        return differences(tmp_path, f"{name}-1", f"{name}-{ranks}")

    differing = {ranks: run(ranks) for ranks in (1, 2, 3, 4)}
    differing["borders moved"] = run(2, MOVED)
    assert not any(differing.values()), differing


@pytest.mark.parametrize(("program", "name"), SCENES)
def test_snapshots_at_random_steps_go_on_with_other_ranks(program, name, tmp_path, on_ranks):
    """Snapshots of 4 ranks go on with 1, 2 and 3 ranks, those of 1 rank with 4."""
    steps = np.random.default_rng(23).choice(np.arange(2, LATEST), WINDOWS, replace=False)
    windows = sorted(steps.tolist())
    for ranks, earlier in ((1, 0), (4, 0), (1, 4), (2, 4), (3, 4), (4, 1)):
        arguments = (HERE / program, tmp_path, ",".join(map(str, windows)), earlier, name)
        on_ranks(RANK_PROGRAM, ranks, *arguments, seconds=3000)
    differing = [
        (ranks, earlier, last)
        for ranks, earlier in ((1, 4), (2, 4), (3, 4), (4, 1))
        for _, last in pairwise(windows)
        if differences(tmp_path, f"{name}-1@{last}", f"{name}-{ranks}-{earlier}@{last}")
    ]
    assert not differing
