"""The mass balance counts each particle that came or left once, under its reason."""

from typing import Any

import numpy as np
import pytest
from fluid_params import fluid_params

from quintet.components.sph_fluid.component import SphFluid
from quintet.components.sph_fluid.mass_balance.losses import begin_books
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.interfaces.errors import StepError

FLUID = (((0.0, 0.0, 0.0), (0.1, 0.1, 0.1)),)
MASS = 1000.0 * 0.02**3  # kg, of a particle


def tank(**changes: Any) -> SphFluid:
    """A cube of 125 particles in a tank open at x+ and z+."""
    settings: dict[str, Any] = {
        "spacing": 0.02,
        "sound_speed": 20.0,
        "fluid": FLUID,
        "boundary__walls": ((0.0, 0.0, 0.0), (0.1, 0.1, 0.2)),
        "boundary__open_faces": ("x+", "z+"),
    }
    return SphFluid(fluid_params(**(settings | changes)))


def throw(fluid: SphFluid, rows: Any, place: tuple[float, float, float]) -> None:
    """Put particles at a place, as if they had gone there, and make lists."""
    state = {name: np.array(array) for name, array in fluid.save().items()}
    state["position_density"][rows, :3] = place
    state["reference"] = np.zeros((0, 3))
    fluid.load(state)
    fluid.step(1e-6)


def balance(fluid: SphFluid) -> dict[str, float]:
    """Masses by reason, in particles."""
    totals = fluid.totals()
    assert sum(totals.mass_balance.values()) == pytest.approx(totals.mass, rel=1e-14)
    return {reason: mass / MASS for reason, mass in totals.mass_balance.items()}


def test_a_fluid_that_keeps_all_has_what_it_began_with() -> None:
    assert balance(tank()) == {"at the start": pytest.approx(125.0)}


@pytest.mark.parametrize(
    ("place", "reason"),
    [
        ((0.35, 0.05, 0.05), "lost outside the domain, over the open face x+"),
        ((-0.35, 0.05, 0.05), "lost through the wall x-"),
        ((0.05, 0.05, -0.35), "lost through the wall z-"),
    ],
)
def test_a_lost_particle_is_booked_under_the_face_that_it_passed(
    place: tuple[float, float, float], reason: str
) -> None:
    fluid = tank()
    throw(fluid, [0], place)
    assert balance(fluid) == {"at the start": pytest.approx(125.0), reason: pytest.approx(-1.0)}


def test_what_falls_beside_a_wall_that_it_went_over_went_over_the_rim() -> None:
    """It is noted near the face that it passed, not where it is lost."""
    fluid = tank()
    throw(fluid, [0], (0.05, -0.005, 0.21))
    assert balance(fluid) == {"at the start": pytest.approx(125.0)}
    row = int(np.flatnonzero(fluid.state.exit_face)[0])
    throw(fluid, [row], (0.05, -0.35, 0.05))
    assert "lost outside the domain, over the open face z+" in balance(fluid)


def test_what_comes_back_into_the_tank_is_forgiven() -> None:
    fluid = tank()
    throw(fluid, [0], (0.05, 0.05, 0.21))
    row = int(np.flatnonzero(fluid.state.exit_face)[0])
    throw(fluid, [row], (0.05, 0.05, 0.15))
    assert not fluid.state.exit_face.any()


def test_losses_are_saved() -> None:
    fluid, loaded = tank(), tank()
    throw(fluid, [0], (-0.35, 0.05, 0.05))
    loaded.load(fluid.save())
    assert balance(loaded) == balance(fluid)


def test_the_run_ends_where_more_is_lost_than_allowed_and_names_the_first() -> None:
    fluid = tank(lost_limit=0.01)
    throw(fluid, [7], (-0.35, 0.05, 0.04))
    with pytest.raises(StepError) as error:
        throw(fluid, [0], (0.35, 0.05, 0.05))
    text = str(error.value)
    assert "at most 0.01 of the fluid may be lost (lost_limit); 2 of 125 particles are" in text
    assert "1 lost through the wall x-, 1 lost outside the domain, over the open face x+" in text
    assert "The first, particle 7, left the tank through the wall x-" in text
    assert "was lost at (-0.35, 0.05, 0.04) m" in text
    assert error.value.place == pytest.approx((-0.35, 0.05, 0.04))


def test_a_limit_of_losses_needs_a_tank() -> None:
    with pytest.raises(ValueError, match=r"lost_limit needs boundary\.walls"):
        fluid_params(spacing=0.02, sound_speed=20.0, fluid=FLUID, lost_limit=0.1)
    assert SphFluidParams.__dataclass_fields__["lost_limit"].default is None


def test_books_that_begin_again_forget_all_that_came_and_went() -> None:
    fluid = tank()
    state = fluid.state
    state.passed = np.array([3, 2])
    state.lost_through[:], state.crossings[:], state.judged[:] = 1, 2, 3.0
    state.first_lost, state.returned, state.removed, state.carried = np.ones(5), 1, 2, 4.0
    begin_books(state, state.fluid)
    assert state.at_start == state.fluid
    assert not (state.passed.any() or state.lost_through.any() or state.crossings.any())
    assert not (state.judged.any() or len(state.first_lost))
    assert (state.lost, state.returned, state.removed, state.carried) == (0, 0, 0, 0.0)
