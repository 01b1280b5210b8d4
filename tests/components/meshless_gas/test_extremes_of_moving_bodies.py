"""Bodies in a gas under extreme conditions: fast, in a blast, jerked, with too long steps."""

import numpy as np
import pytest
from test_moving_clouds import PRESSURE, RADIUS, gas_of, scene

from quintet.components.meshless_gas.blunt_bodies import pitot_pressure
from quintet.interfaces.errors import SceneError, StepError

pytestmark = pytest.mark.full


def gas_at(settings, end):
    """A gas that was stepped to a time [s]."""
    gas = gas_of(settings)
    while gas.state.time < end * (1.0 - 1e-12):
        gas.step(min(gas.stable_dt(), end - gas.state.time))
    return gas


def test_a_cylinder_that_flies_at_mach_20_is_computed_without_floors():
    mach, way = 20.0, 6.0
    settings = scene(share=1.0, way=way, gas=[0.0, 0.0, 0.0])
    settings["moving"]["bodies"][0]["velocity"] = [-mach, 0.0, 0.0]
    gas = gas_at(settings, way * RADIUS / mach)
    inner = gas.motion.domain.inner
    assert (gas.state.primitive[inner][:, [0, 4]] > 0.0).all()
    pressure = gas.give(frozenset(["bodies.highest_pressure"]))["bodies.highest_pressure"][0]
    assert pressure == pytest.approx(pitot_pressure(mach, 1.4) * PRESSURE, rel=0.1)
    assert gas.state.primitive[inner, 0].min() < 0.2  # kg/m3, in the wake


def test_a_blast_of_1e5_times_the_pressure_passes_over_a_body():
    settings = scene(gas=[0.0, 0.0, 0.0])
    settings["zones"] = [
        {
            "lowest": [-1.7, -1.0, -1.7],
            "highest": [-1.4, 1.0, 1.7],
            "state": {"density": 1.0, "pressure": 1e5 * PRESSURE},
        }
    ]
    gas = gas_at(settings, 7e-3)
    assert (gas.state.primitive[gas.motion.domain.inner][:, [0, 4]] > 0.0).all()
    outputs = gas.give(frozenset(["bodies.force", "bodies.highest_pressure"]))
    assert outputs["bodies.highest_pressure"][0] > 1e4 * PRESSURE
    assert outputs["bodies.force"][0, 0] > 0.0


def test_a_step_beyond_the_limit_ends_with_where_and_what_to_do():
    gas = gas_of(scene(share=1.0))
    with pytest.raises(StepError, match=r"the node at .* m has .* Lower courant"):
        for _ in range(20):
            gas.step(4.0 * gas.scheme.shortest_step)


def test_a_partner_that_says_a_body_is_elsewhere_is_refused():
    settings = scene(share=1.0)
    settings["moving"]["bodies"][0]["is_driven"] = True
    gas = gas_of(settings)
    place = gas.motion.pose.centre + np.array([0.5, 0.0, 0.0])
    gas.take({"motion.position": place, "motion.velocity": gas.motion.pose.velocity})
    with pytest.raises(SceneError, match="must begin and go on where the gas has them"):
        gas.step(gas.stable_dt())
