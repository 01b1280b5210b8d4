"""A lattice on several MPI ranks: the same bits on any number of ranks."""

from pathlib import Path

import numpy as np
import pytest
from rank_runs import differences, from_states, from_the_start

pytestmark = pytest.mark.mpi
PROGRAM = Path(__file__).with_name("lattice_on_ranks.py")
NAMES = ("driven", "heated", "periodic", "breaks up")
STEPS = 45  # enough for new lists in warm lattices
folder = from_the_start(PROGRAM, NAMES, STEPS)
resumed = from_states(PROGRAM, NAMES, 12)


@pytest.mark.parametrize("name", NAMES)
def test_two_ranks_compute_what_one_does_to_the_bit(name, folder):
    assert differences(folder, f"{name}-1", f"{name}-2") == []


@pytest.mark.parametrize("name", NAMES)
def test_a_state_of_two_ranks_goes_on_with_three_as_one_goes_on(name, resumed):
    assert differences(resumed, f"{name}-1-1", f"{name}-3-2") == []


def test_broken_bonds_are_counted_over_all_ranks(resumed):
    assert "broken bonds" in np.load(resumed / "breaks up-3-2.npz")["warned"]


REFUSED = """
from mpi4py import MPI
from quintet.components.particle_dynamics.component import ParticleLattice
from quintet.components.particle_dynamics.params import *
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import SceneError

lattice = Lattice(cells=(1, 1, 1), spacing=0.01, mass=1e-3)
force = SevenRootForce(top_frequency=50.0)
damping = Damping(coefficient=1e-3, range="all")
try:
    params = ParticleLatticeParams(lattice=lattice, seven_roots=force, damping=damping)
    ParticleLattice(params, Resources(communicator=MPI.COMM_WORLD))
except SceneError as error:
    print(error)
"""


def test_damping_of_all_pairs_is_refused_on_two_ranks(tmp_path, on_ranks):
    program = tmp_path / "refused.py"
    program.write_text(REFUSED)
    sentence = "the range all needs every pair of points, so the lattice cannot be shared out"
    assert sentence in on_ranks(program, 2)
