"""The ledger detects defects between two components; each defect is put in on purpose."""

import laboratory
import numpy as np
import pytest

from quintet.coupler.coupling.mapping import RigidMap, ShapeMap
from quintet.coupler.coupling.participant import Participant
from quintet.coupler.coupling.schedule import Coupling, Given
from quintet.interfaces.errors import OrderError
from quintet.interfaces.serving.inputs import Inputs
from quintet.interfaces.serving.order_guard import OrderGuard
from quintet.interfaces.serving.serve import Server

LIMIT = 1e-12
SCHEMES = ["serial", "parallel", "iterated"]


def _plate(folder, scheme="serial", order=("gust", "plate")):
    components = {
        "gust": {"kind": "toy_plates:Gust", "dt": 0.02 / 3},
        "plate": {"kind": "toy_plates:Plate", "dt": 0.02},
    }
    link = {"kind": "fsi", "between": ["gust", "plate"]}
    settings = {"end": 0.6, "window": 0.02, "scheme": scheme, "order": list(order)}
    return laboratory.couple(laboratory.scene(folder, components, link, **settings)).account


def _balls(folder, scheme="serial", order=("balls", "gust")):
    components = {
        "gust": {"kind": "toy_plates:Gust", "dt": 0.02 / 3, "depth": 0.07},
        "balls": {"kind": "toy_bodies:Balls", "dt": 0.02},
    }
    link = {"kind": "fsi", "between": ["gust", "balls"]}
    settings = {"end": 0.6, "window": 0.02, "scheme": scheme, "order": list(order)}
    return laboratory.couple(laboratory.scene(folder, components, link, **settings)).account


@pytest.mark.parametrize("order", [("gust", "plate"), ("plate", "gust")])
@pytest.mark.parametrize("scheme", SCHEMES)
def test_an_undisturbed_run_of_a_plate_is_clean(tmp_path, scheme, order):
    account = _plate(tmp_path, scheme, order)
    assert account.momentum_residual <= LIMIT
    assert account.kinematic_residual <= LIMIT
    assert account.energy_residual < 0.1


@pytest.mark.parametrize("scheme", SCHEMES)
def test_an_undisturbed_run_of_balls_is_clean(tmp_path, scheme):
    account = _balls(tmp_path, scheme)
    assert account.momentum_residual <= LIMIT
    assert account.kinematic_residual <= LIMIT
    assert account.angular_residual < 2e-3  # arms at the window's middle, not at every step's
    assert account.energy_residual < 0.1


def _change_answers(monkeypatch, name, change):
    """Change every window's answer of a component on its way."""
    finish = Participant.finish

    def finish_changed(participant):
        message = finish(participant)
        if participant.name == name:
            message.fields = {key: change(key, array) for key, array in message.fields.items()}
        return message

    monkeypatch.setattr(Participant, "finish", finish_changed)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_dropped_sample_shows(tmp_path, monkeypatch, scheme):
    def drop(key, array):
        array = np.array(array)
        if key == "surface_load.force":
            array[7] = 0.0
        return array

    _change_answers(monkeypatch, "gust", drop)
    assert _plate(tmp_path, scheme).momentum_residual > 1e-4


def test_one_bit_too_many_in_a_force_shows(tmp_path, monkeypatch):
    """The threshold is sharp: a force that is wrong by 1e-9 of itself is seen."""
    _change_answers(monkeypatch, "gust", lambda key, array: array * (1.0 + 1e-9))
    assert _plate(tmp_path).momentum_residual > 1e-11


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_wrong_sign_of_the_mapped_force_shows(tmp_path, monkeypatch, scheme):
    conservative = ShapeMap.map_conservative
    monkeypatch.setattr(
        ShapeMap, "map_conservative", lambda self, values: -conservative(self, values)
    )
    assert _plate(tmp_path, scheme).momentum_residual > 0.1


def test_a_wrong_sign_of_one_axis_shows(tmp_path, monkeypatch):
    conservative = ShapeMap.map_conservative
    mirror = np.array([1.0, 1.0, -1.0])
    monkeypatch.setattr(
        ShapeMap, "map_conservative", lambda self, values: mirror * conservative(self, values)
    )
    assert _plate(tmp_path).momentum_residual > 0.1


def test_a_wrong_sign_of_the_torque_shows(tmp_path, monkeypatch):
    conservative = RigidMap.map_conservative

    def negated(self, force, arms):
        total, torque = conservative(self, force, arms)
        return total, -torque

    monkeypatch.setattr(RigidMap, "map_conservative", negated)
    assert _balls(tmp_path).angular_residual > 0.01


def test_a_wrong_sign_of_the_mapped_velocity_shows_in_the_work(tmp_path, monkeypatch):
    consistent = ShapeMap.map_consistent

    def negated(self, values):
        mapped = consistent(self, values)
        return mapped if np.abs(values).max() > 1.0 else -mapped  # velocities, not positions

    monkeypatch.setattr(ShapeMap, "map_consistent", negated)
    assert _plate(tmp_path, "parallel").energy_residual > 0.5


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("run", [_plate, _balls])
def test_inputs_half_a_step_late_or_early_show(tmp_path, monkeypatch, scheme, run):
    over = Inputs.over
    for shift in (0.5, -0.5, 1e-3):

        def over_shifted(self, begin, end, window, shift=shift):
            late = shift * (end - begin)
            return over(self, begin + late, end + late, window)

        monkeypatch.setattr(Inputs, "over", over_shifted)
        assert run(tmp_path, scheme).kinematic_residual > 100 * LIMIT


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("window", [0, 13, 28])
def test_a_window_lost_between_two_components_shows(tmp_path, monkeypatch, scheme, window):
    """The gust's output of one window is lost; the output before it is applied once more."""
    advance = Coupling.advance_outputs

    def lose_window(self, answers):
        if "gust" in answers.outputs and self.windows.done == window:
            answers = Given({"gust": self.outputs["gust"]}, {"gust": self.sent["gust"]})
        advance(self, answers)

    monkeypatch.setattr(Coupling, "advance_outputs", lose_window)
    assert _plate(tmp_path, scheme).momentum_residual > 1e-5


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_window_applied_twice_shows(tmp_path, monkeypatch, scheme):
    advance = Server.advance

    def advance_twice(self, window, asked=0):
        steps, applied, fields = advance(self, window, asked)
        if "node_load.force" in self.inputs.fields and self.guard.window == 14:
            more_steps, applied_again, fields = advance(self, window)
            steps += more_steps
            applied = {key: (np.add(a, applied_again[key])).tolist() for key, a in applied.items()}
        return steps, applied, fields

    monkeypatch.setattr(Server, "advance", advance_twice)
    assert _plate(tmp_path, scheme).momentum_residual > 0.1


def test_a_window_ordered_twice_is_refused():
    guard = OrderGuard("plate")
    for order in ("describe", "bind", "prime"):
        guard.allow(order)
    guard.allow("advance", 0)
    with pytest.raises(OrderError, match="window 1 is next; window 0 was ordered"):
        guard.allow("advance", 0)
    with pytest.raises(OrderError, match="window 1 is next; window 2 was ordered"):
        guard.allow("advance", 2)


def test_heat_that_is_lost_shows(tmp_path, monkeypatch):
    def cool(key, array):
        return 0.9 * array if key == "breath.heat" else array

    _change_answers(monkeypatch, "air", cool)
    components = {"pucks": {"kind": "toy_points:Pucks"}, "air": {"kind": "toy_points:Air"}}
    pairs = [["pucks.flight", "air.flight"], ["air.breath", "pucks.breath"]]
    link = {"kind": "direct", "pairs": pairs}
    path = laboratory.scene(tmp_path, components, link, end=1.0, window=0.02, scheme="serial")
    account = laboratory.couple(path).account
    assert account.heat_residual > 0.05
    assert account.momentum_residual <= LIMIT
