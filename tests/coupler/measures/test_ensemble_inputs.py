"""What the spread of an ensemble comes from, against distributions that are known."""

import numpy as np
import pytest

from quintet.coupler.measures.ensemble_inputs import origins


def sample(random, runs=32, chance=0.5):
    """Inputs of runs, and a quantity: 3 + 40 friction + 0.2 depth + chance."""
    friction, depth = random.normal(0.15, 0.02, runs), random.uniform(-2.0, 2.0, runs)
    quantity = 3.0 + 40.0 * friction + 0.2 * depth + random.normal(0.0, chance, runs)
    return {"friction": friction, "depth": depth}, quantity


def test_a_line_is_explained_to_rounding():
    inputs, quantity = sample(np.random.default_rng(0), chance=0.0)
    explained = origins(inputs, quantity, 10.0)
    friction, depth = explained.effects
    assert friction.slope == pytest.approx(40.0) and depth.slope == pytest.approx(0.2)
    assert explained.remainder == pytest.approx(0.0, abs=1e-9)
    met = (10.0 - 3.0 - 0.2 * inputs["depth"].mean()) / 40.0
    assert friction.met_at == pytest.approx(met)
    assert friction.met_between == pytest.approx((met, met))


def test_shares_are_those_of_the_variances():
    explained = origins(*sample(np.random.default_rng(1), 20000), None)
    parts = np.array([(40.0 * 0.02) ** 2, 0.04 * 16.0 / 12.0, 0.25])
    shares = [effect.share for effect in explained.effects] + [explained.remainder_share]
    assert shares == pytest.approx(parts / parts.sum(), abs=0.01)
    assert explained.effects[0].met_at is None  # without a reference


def test_intervals_cover_as_often_as_they_say():
    """The slope; and the friction at which a further run was made, by that run's value."""
    random, slopes, frictions = np.random.default_rng(2), [], []
    for _ in range(2000):
        inputs, quantity = sample(random)
        friction = random.normal(0.15, 0.02)
        further = 3.0 + 40.0 * friction + 0.2 * inputs["depth"].mean() + random.normal(0.0, 0.5)
        effect = origins(inputs, quantity, further).effects[0]
        slopes.append(effect.interval[0] <= 40.0 <= effect.interval[1])
        low, high = effect.met_between
        frictions.append(low <= friction <= high)
    assert np.mean(slopes) == pytest.approx(0.95, abs=0.015)
    assert np.mean(frictions) == pytest.approx(0.95, abs=0.015)


def test_no_value_of_an_input_without_effect_is_told():
    random = np.random.default_rng(3)
    inputs, quantity = sample(random)
    inputs["gate"] = random.normal(size=len(quantity))
    gate = origins(inputs, quantity, 9.0).effects[2]
    assert gate.interval[0] < 0.0 < gate.interval[1] and gate.met_at is gate.met_between is None


@pytest.mark.parametrize("runs", [0, 1, 5])
def test_few_runs_explain_nothing(runs):
    inputs, quantity = sample(np.random.default_rng(4), runs)
    assert origins(inputs, quantity, None) is None
    assert origins({"friction": np.ones(32)}, np.arange(32.0), None) is None


@pytest.mark.parametrize(("runs", "is_explained"), [(16, False), (17, True)])
def test_eight_inputs_need_twice_as_many_runs(runs, is_explained):
    """With fewer, shares of one input above the whole variance come from chance."""
    random = np.random.default_rng(5)
    inputs = {f"input {k}": random.normal(size=runs) for k in range(8)}
    assert (origins(inputs, random.normal(size=runs), None) is not None) == is_explained
