"""Solvers on one to four MPI ranks: the same bits after many steps, and after restarts.

`particle_spheres` has the same tests in particle_dynamics/test_spheres_ranks.py.
"""

import shutil
from pathlib import Path

import numpy as np
import pytest
from rank_runs import MOVED_BORDERS, differences

pytestmark = [pytest.mark.mpi, pytest.mark.full]
HERE = Path(__file__).parent
STEPS = 1000
WINDOWS, LATEST, FURTHER = 10, 60, 6  # snapshots, the last step of one, and steps after it
CASES = {
    "sph_fluid/fluid_on_ranks.py": ("dam", "symmetric", "body"),
    "sph_solid/solid_on_ranks.py": ("impact", "quarter", "glued"),
    "dem_bodies/dem_on_ranks.py": ("heap", "rolling", "boxes"),
    "fe_plate/structure_on_ranks.py": ("struck", "pressed", "bent", "glued", "plane"),
    "meshless_gas/gas_on_ranks.py": ("vortex",),
    "particle_dynamics/lattice_on_ranks.py": ("driven", "heated", "periodic", "breaks up"),
}
SCENES = [(program, name) for program, names in CASES.items() for name in names]


@pytest.mark.parametrize(("program", "name"), SCENES)
def test_many_steps_give_the_same_bits_on_one_to_four_ranks(program, name, tmp_path, on_ranks):
    differing = {}
    for ranks in (1, 2, 3, 4):
        on_ranks(HERE / program, ranks, tmp_path, STEPS, 0, name, seconds=3000)
        differing[ranks] = differences(tmp_path, f"{name}-1", f"{name}-{ranks}")
    on_ranks(MOVED_BORDERS, 2, HERE / program, tmp_path, STEPS, 0, name, seconds=3000)
    differing["borders moved"] = differences(tmp_path, f"{name}-1", f"{name}-2")
    assert not any(differing.values()), differing


@pytest.mark.parametrize(("program", "name"), SCENES)
def test_snapshots_at_random_steps_go_on_with_other_ranks(program, name, tmp_path, on_ranks):
    """Of 4 ranks on 1, 2 and 3, and of 1 on 4: as that of 1 goes on with 1."""
    steps = np.random.default_rng(23).choice(np.arange(2, LATEST), WINDOWS, replace=False)
    differing = []
    for step in steps.tolist():
        for ranks in (1, 4):
            on_ranks(HERE / program, ranks, tmp_path, step, 0, name, seconds=600)
        for earlier, ranks in ((1, 1), (4, 1), (4, 2), (4, 3), (1, 4)):
            folder = tmp_path / f"{step}-{earlier}-{ranks}"
            folder.mkdir()
            shutil.copy(tmp_path / f"{name}-{earlier}-state.npz", folder)
            on_ranks(HERE / program, ranks, folder, FURTHER, earlier, name, seconds=600)
            reached = f"{step}-{earlier}-{ranks}/{name}-{ranks}-{earlier}"
            if differences(tmp_path, f"{step}-1-1/{name}-1-1", reached):
                differing.append((step, earlier, ranks))
    assert differing == []
