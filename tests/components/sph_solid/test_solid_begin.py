"""Bodies of particles that begin from the state of another run."""

import numpy as np
import pytest

from quintet.components.shared.materials.params import Material
from quintet.components.sph_solid.component import SphSolid
from quintet.components.sph_solid.params import Body, Fixed, SphSolidParams
from quintet.interfaces.errors import SceneError

DX = 0.01  # m
RUBBER = Material(density=1000.0, youngs_modulus=1e7, poissons_ratio=0.3)


def block(long=6, spacing=DX, left=0.0, speed=1.0, **more):
    highest = (left + long * DX, 4 * DX, 4 * DX)
    gradient = ((speed / DX, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    body = Body(
        lowest=(left, 0.0, 0.0), highest=highest, material=RUBBER, velocity_gradient=gradient
    )
    return SphSolid(SphSolidParams(spacing=spacing, bodies=(body,), **more))


def advance(solid, steps):
    for _ in range(steps):
        solid.step(solid.stable_dt())
    return solid


@pytest.mark.parametrize("keeps", [False, True])
def test_nothing_changed_goes_on_with_the_same_bits_and_a_clock_at_0(keeps):
    first = advance(block(total_lagrangian=keeps), 40)
    again = block(total_lagrangian=keeps)
    again.begin_from(first.save())
    assert again.state.time == 0.0 and again.state.steps == 0
    advance(first, 40)
    advance(again, 40)
    for name in ("position", "velocity", "deviator", "energy", "bound"):
        np.testing.assert_array_equal(getattr(again.state, name), getattr(first.state, name))


def test_warnings_of_the_run_before_do_not_carry_over():
    first = advance(block(), 40)
    first.state.torn[:] = 1000.0, 1e-3, 0.0, 0.0, 0.0
    first.state.sums[2] = 1e6
    assert {"fracture", "energy"} <= set(first.warnings())
    again = block()
    again.begin_from(first.save())
    assert not again.warnings()
    heat = first.state.viscous[0]
    advance(again, 1)
    assert again.state.viscous[2] > 0.5 * heat > again.state.viscous[0] == 0.0
    assert not again.warnings()


@pytest.mark.parametrize(
    ("other", "text"),
    [
        ({"long": 5}, "as many particles as in the state that it begins from, 96; found 80"),
        ({"spacing": 0.02}, "as many particles as in the state that it begins from, 96; found 12"),
        ({"long": 12, "spacing": 0.0125}, "as many particles .* Make spacing and bodies"),
        ({"left": 0.03, "total_lagrangian": True}, "found another place at the start of up to 96"),
        (
            {"fixed": ({"lowest": (-1.0, -1.0, -1.0), "highest": (DX, 1.0, 1.0)},)},
            "found another fixed of up to 16 particles",
        ),
    ],
)
def test_a_state_of_other_particles_is_refused(other, text):
    state = advance(block(total_lagrangian=other.get("total_lagrangian", False)), 1).save()
    if "fixed" in other:
        other = {"fixed": tuple(Fixed(**region) for region in other["fixed"])}
    with pytest.raises(SceneError, match=text):
        block(**other).begin_from(state)


def test_particles_of_another_size_are_refused_though_as_many():
    state = advance(block(), 1).save()
    state["volume"] = 8.0 * state["volume"]
    with pytest.raises(SceneError, match="found another volume of up to 96 particles"):
        block().begin_from(state)
