"""Spheres on several MPI ranks: the same bits on any number of ranks."""

from pathlib import Path

import numpy as np
import pytest
from rank_runs import differences, from_states, from_the_start

pytestmark = pytest.mark.mpi
PROGRAM = Path(__file__).with_name("spheres_on_ranks.py")
NAMES = ("gas", "pile", "too long steps", "row", "streams", "tethered", "parcels")
STEPS = 15  # enough for new lists and for rows that change their rank
folder = from_the_start(PROGRAM, NAMES, STEPS)
resumed = from_states(PROGRAM, NAMES, 5)


@pytest.mark.parametrize("name", NAMES)
def test_two_ranks_compute_what_one_does_to_the_bit(name, folder):
    assert differences(folder, f"{name}-1", f"{name}-2") == []


@pytest.mark.parametrize("name", NAMES)
def test_a_state_of_two_ranks_goes_on_with_three_as_one_goes_on(name, resumed):
    assert differences(resumed, f"{name}-1-1", f"{name}-3-2") == []


def test_the_cases_have_impacts_and_what_they_report(folder, resumed):
    for name in ("gas", "pile", "too long steps", "row", "streams"):
        assert np.load(resumed / f"{name}-3-2.npz")["state sums"][1] > 0.0  # J, lost in impacts
    for name in NAMES:
        assert str(np.load(folder / f"{name}-2.npz")["failure"]).startswith(
            "sphere 3: its velocity"
        )


REFUSED = """
from mpi4py import MPI
from quintet.components.particle_dynamics.spheres.component import ParticleSpheres
from quintet.components.particle_dynamics.spheres.params import *
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import SceneError

sphere = Sphere(centre=(0.0, 0.0, 0.0), radius=0.01, density=1e3)
try:
    params = ParticleSpheresParams(spheres=(sphere,))
    ParticleSpheres(params, Resources(communicator=MPI.COMM_WORLD))
except SceneError as error:
    print(error)
"""


def test_more_ranks_than_spheres_are_refused(tmp_path, on_ranks):
    program = tmp_path / "refused.py"
    program.write_text(REFUSED)
    assert "each must own a sphere; there are 1 for 2 ranks" in on_ranks(program, 2)
