"""Bodies of particles that begin from the state of another run."""

import numpy as np
import pytest

from quintet.components.shared.materials.params import Material
from quintet.components.sph_solid.component import SphSolid
from quintet.components.sph_solid.params import Body, Fixed, SphSolidParams
from quintet.interfaces.errors import SceneError

DX = 0.01  # m
RUBBER = Material(density=1000.0, youngs_modulus=1e7, poissons_ratio=0.3)


def block(long=6, spacing=DX, left=0.0, speed=1.0, **settings):
    highest = (left + long * DX, 4 * DX, 4 * DX)
    gradient = ((speed / DX, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    body = Body(
        lowest=(left, 0.0, 0.0), highest=highest, material=RUBBER, velocity_gradient=gradient
    )
    return SphSolid(SphSolidParams(spacing=spacing, bodies=(body,), **settings))


def advance(solid, steps):
    for _ in range(steps):
        solid.step(solid.stable_dt())
    return solid


@pytest.mark.parametrize("total_lagrangian", [False, True])
def test_nothing_changed_goes_on_with_the_same_bits_and_a_clock_at_0(total_lagrangian):
    original = advance(block(total_lagrangian=total_lagrangian), 40)
    restarted = block(total_lagrangian=total_lagrangian)
    restarted.begin_from(original.save())
    assert restarted.state.time == 0.0 and restarted.state.steps == 0
    advance(original, 40)
    advance(restarted, 40)
    for name in ("position", "velocity", "deviator", "energy", "bound"):
        np.testing.assert_array_equal(getattr(restarted.state, name), getattr(original.state, name))


def test_warnings_of_the_run_before_do_not_carry_over():
    original = advance(block(), 40)
    original.state.torn[:] = 1000.0, 1e-3, 0.0, 0.0, 0.0
    original.state.sums[2] = 1e6
    assert {"fracture", "energy"} <= set(original.warnings())
    restarted = block()
    restarted.begin_from(original.save())
    assert not restarted.warnings()
    heat = original.state.viscous[0]
    advance(restarted, 1)
    assert restarted.state.viscous[2] > 0.5 * heat > restarted.state.viscous[0] == 0.0
    assert not restarted.warnings()


@pytest.mark.parametrize(
    ("settings", "message"),
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
def test_a_state_of_other_particles_is_refused(settings, message):
    state = advance(block(total_lagrangian=settings.get("total_lagrangian", False)), 1).save()
    if "fixed" in settings:
        settings = {"fixed": tuple(Fixed(**region) for region in settings["fixed"])}
    with pytest.raises(SceneError, match=message):
        block(**settings).begin_from(state)


def test_particles_of_another_size_are_refused_though_as_many():
    state = advance(block(), 1).save()
    state["volume"] = 8.0 * state["volume"]
    with pytest.raises(SceneError, match="found another volume of up to 96 particles"):
        block().begin_from(state)


@pytest.mark.parametrize("total_lagrangian", [False, True])
def test_a_larger_smoothing_length_finds_its_neighbours(total_lagrangian):
    state = advance(block(total_lagrangian=total_lagrangian), 2).save()
    fresh = block(total_lagrangian=total_lagrangian, smoothing=1.6)
    count = len(fresh.lists.near.list)
    wide = block(total_lagrangian=total_lagrangian, smoothing=1.6)
    wide.begin_from(state)
    assert wide.state.reach == fresh.state.reach
    assert len(wide.lists.near.list) == pytest.approx(count, rel=0.02)
