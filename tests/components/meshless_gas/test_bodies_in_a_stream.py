"""A sphere in a stream: forces on it, a flow that settles, states that come back."""

import math

import numpy as np
import pytest

from quintet.components.meshless_gas.component import MeshlessGas
from quintet.components.meshless_gas.parts import Walls
from quintet.components.meshless_gas.ranks.one import OneRank
from quintet.components.meshless_gas.readings import Steady
from quintet.components.meshless_gas.steady import SteadyMonitor
from quintet.components.meshless_gas.wall_loads import sums
from quintet.interfaces.component import fields_of
from quintet.interfaces.errors import StepError
from quintet.interfaces.params import read

STREAM = {"density": 1.0, "pressure": 1.0 / 1.4, "velocity": [3.0, 0.0, 0.0]}


class PushedWall(Walls):
    """A wall under a force along x."""

    push = 1.0

    def force(self, primitive: np.ndarray) -> np.ndarray:
        return np.array([self.push, 0.0, 0.0])

    def scale(self, primitive: np.ndarray) -> float:
        return 1.0


def sphere(**keys: object) -> MeshlessGas:
    """A coarse gas round a sphere at M = 3."""
    table = {
        "axisymmetric": True,
        "gas": {"gas_constant": 1.0 / 1.4},
        "initial": STREAM,
        "sphere": {"radius": 1.0, "points_around": 8, "layers": {"count": 8}},
        "boundaries": {
            "wall": {"kind": "slip"},
            "far": {"kind": "inflow", "state": STREAM},
            "exit": {"kind": "outflow"},
        },
    }
    params, mistakes = read(MeshlessGas.Params, table | keys, "gas")
    assert not mistakes
    return MeshlessGas(params)


def test_a_uniform_pressure_pushes_a_closed_surface_nowhere() -> None:
    angle = (np.arange(400) + 0.5) * math.pi / 400
    normal = np.stack([-np.cos(angle), 0.0 * angle, np.sin(angle)], axis=1)
    sizes = 2.0 * math.pi * np.sin(angle) * math.pi / 400
    still = np.zeros((400, 3))
    total_force = sums(np.full(400, 5.0), still, normal * sizes[:, None], sizes, True)
    assert total_force == pytest.approx(np.zeros(3), abs=1e-10)
    half_force = sums(
        np.where(angle < 0.5 * math.pi, 5.0, 0.0), still, normal * sizes[:, None], sizes, True
    )
    # Pressure times the cross-section.
    assert half_force[0] == pytest.approx(5.0 * math.pi, rel=1e-4)


def test_a_sphere_is_pushed_downstream_and_the_step_is_told() -> None:
    gas = sphere()
    for _ in range(60):
        gas.step(gas.stable_dt())
    outputs = gas.give(frozenset(fields_of(gas.gives)))
    assert 0.7 < outputs["body.drag_coefficient"][0] < 1.1  # a forebody at M = 3: 0.9
    assert outputs["body.force"][0, 0] > 0.0
    with pytest.raises(StepError):
        for _ in range(60):
            gas.step(6.0 * gas.stable_dt())


def test_a_settled_flow_stands_still_and_says_so() -> None:
    gas = sphere(steady={"steps": 5, "change": 1.0, "force": 1.0})
    while math.isfinite(gas.stable_dt()):
        gas.step(gas.stable_dt())
    saved_state = gas.save()
    gas.step(1.0)
    assert (gas.save()["conservative"] == saved_state["conservative"]).all()
    assert gas.give(frozenset({"body.settled"}))["body.settled"] == 1.0
    resumed = sphere(steady={"steps": 5, "change": 1.0, "force": 1.0})
    resumed.load(saved_state)
    assert math.isinf(resumed.stable_dt())
    restarted = sphere(steady={"steps": 5, "change": 1.0, "force": 1.0})
    restarted.begin_from(saved_state)  # its stream may be another
    assert math.isfinite(restarted.stable_dt())
    restarted.step(restarted.stable_dt())
    assert (restarted.save()["conservative"] != saved_state["conservative"]).any()


def test_nothing_tells_whether_a_flow_has_settled_where_no_steady_says_when() -> None:
    gas, steady_gas = sphere(), sphere(steady={"steps": 5})
    assert "body.settled" not in fields_of(gas.gives)
    assert "body.settled" in fields_of(steady_gas.gives)
    assert steady_gas.give(frozenset({"body.settled"}))["body.settled"] == 0.0


def test_a_flow_settles_only_when_densities_and_forces_do() -> None:
    walls, domain = PushedWall(), sphere().motion.domain
    states, criteria = np.ones((domain.cloud.nodes, 5)), Steady(steps=1, change=1e-3, force=1e-2)
    monitor = SteadyMonitor(criteria, walls, states, domain, OneRank())
    monitor.update(states, 1e-4, 0.1)  # the force was 0 before
    assert not monitor.is_settled
    monitor.update(states, 1e-2, 0.2)
    assert not monitor.is_settled
    walls.push = 1.001
    monitor.update(states, 1e-4, 0.3)
    assert monitor.is_settled


def test_a_run_that_ends_before_its_flow_has_settled_warns():
    gas = sphere(steady={"change": 1e-9}, limiter="van_albada")
    for _ in range(60):
        gas.step(gas.stable_dt())
    assert "has not settled" in gas.final_warnings()["steady"]
    before = gas.save()
    for _ in range(1200):
        gas.step(gas.stable_dt())
    assert (
        gas.give(frozenset({"body.settled"}))["body.settled"] == 0.0 and gas.final_warnings() == {}
    )
    gas.load(before)
    assert "has not settled" in gas.final_warnings()["steady"]


@pytest.mark.parametrize(
    ("keys", "sentence"),
    [
        ({"box": {"lowest": [0, 0, 0], "highest": [1, 1, 1], "spacing": 0.1}}, "one of them"),
        ({"axisymmetric": False}, "must be axisymmetric"),
        ({"boundaries": {"wall": {"kind": "slip"}}}, "boundaries.far must be given"),
        (
            {"boundaries": {"wall": {"kind": "isothermal", "temperature": 1.0}}},
            "Say viscous = true",
        ),
    ],
)
def test_what_does_not_fit_round_a_sphere_is_refused(
    keys: dict[str, object], sentence: str
) -> None:
    table = {
        "axisymmetric": True,
        "initial": STREAM,
        "sphere": {"radius": 1.0, "points_around": 8, "layers": {"count": 8}},
    }
    _, mistakes = read(MeshlessGas.Params, table | keys, "gas")
    assert any(sentence in mistake for mistake in mistakes), mistakes
