"""A fluid shared out among real MPI ranks: the same bits on any number of them."""

from pathlib import Path

import numpy as np
import pytest
from fluid_params import fluid_params
from rank_runs import differences, from_states, from_the_start

from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import SceneError

pytestmark = pytest.mark.mpi
PROGRAM = Path(__file__).with_name("fluid_on_ranks.py")
# Cases with terms that are compiled for them alone: test_sph_fluid_ranks_of_other_terms.py.
NAMES = ("dam", "body", "spilling", "rolling", "swaying", "pushed", "absorbing")
STEPS = 120  # with lists made again, and rows that change their rank
folder = from_the_start(PROGRAM, NAMES, STEPS)
resumed = from_states(PROGRAM, NAMES, 40)


class Several:
    """A communicator of two ranks; the tests never call it."""

    size, rank = 2, 0


@pytest.mark.parametrize("name", NAMES)
def test_two_ranks_compute_what_one_does_to_the_bit(name, folder):
    assert differences(folder, f"{name}-1", f"{name}-2") == []


@pytest.mark.parametrize("name", NAMES)
def test_a_state_of_two_ranks_goes_on_with_three_as_one_goes_on(name, resumed):
    assert differences(resumed, f"{name}-1-1", f"{name}-3-2") == []


def test_a_step_that_fails_is_told_as_on_one_rank(folder):
    """The arrays above hold the same sentences."""
    for name in NAMES:
        assert "particle" in str(np.load(folder / f"{name}-2.npz")["failure"])


def test_samples_under_the_contact_potential_are_refused_on_several_ranks():
    box = ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    method = {"boundary.method": "mdbc", "boundary.lubrication_films": False}
    params = fluid_params(spacing=0.1, sound_speed=50.0, fluid=[box], **method)
    fluid = SphFluid(params, Resources(communicator=Several()))
    static = {"normal": np.eye(3)[2:], "volume": np.full(1, 1e-3), "body": np.zeros(1)}
    static = {f"surface.{key}": value for key, value in static.items()}
    with pytest.raises(SceneError, match="contact potential must be chosen for no samples"):
        fluid.bind(static | {"surface.contact": np.ones(1)}, frozenset({"surface"}))


def test_the_cases_lose_fluid_and_move_it(folder):
    assert np.load(folder / "spilling-1.npz")["state lost_through"].sum() > 0
    for name in NAMES:
        assert np.load(folder / f"{name}-1.npz")["view velocity"].max() > 0.5


def test_walls_of_the_contact_potential_are_refused_on_several_ranks():
    box, method = ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)), {"boundary.method": "potential"}
    params = fluid_params(spacing=0.1, sound_speed=50.0, fluid=[box], **method)
    match = r"boundary.method must be .* on 2 ranks; found potential"
    with pytest.raises(SceneError, match=match):
        SphFluid(params, Resources(communicator=Several()))
