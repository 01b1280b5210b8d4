"""The cost model finds the numbers behind its measurements, and predicts times by its law."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import nnls

from quintet.coupler.bench.cost_model import (
    Measurement,
    Network,
    faces,
    fit,
    neighbours,
    not_negative,
    of_measurement,
    of_model,
    of_run,
    parts,
    strong_efficiency,
    weak_efficiency,
)

NETWORK = Network(latency=2e-6, bandwidth=5e9)
KNOWN = {"per_item": 1.3e-6, "per_halo_byte": 2e-9, "per_step": 4e-4}
COUNTED = {"halo": 48.0, "exchanges": 6.0, "collectives": 9.0, "gathered": 0.3}


def synthetic(items, ranks, imbalance=1.07, **changes):
    """A measurement of a component whose numbers are known."""
    numbers = KNOWN | COUNTED | changes
    items_per_rank = items / ranks
    halo = numbers["halo"] * faces(items_per_rank, ranks, 3)
    is_parallel = ranks > 1
    return Measurement(
        items,
        ranks,
        numbers["per_item"] * items_per_rank
        + numbers["per_halo_byte"] * halo
        + numbers["per_step"],
        imbalance if is_parallel else 1.0,
        numbers["exchanges"] * neighbours(ranks, 3),
        halo,
        numbers["collectives"] if is_parallel else 0.0,
        numbers["gathered"] * items * (1.0 - 1.0 / ranks),
    )


MEASURED = [synthetic(items, ranks) for items in (8000, 50653) for ranks in (1, 2, 4)]


def test_known_numbers_are_found_from_one_two_and_four_ranks():
    model = fit(MEASURED)
    for name, value in (KNOWN | COUNTED).items():
        assert getattr(model, name) == pytest.approx(value, rel=1e-9), name
    assert model.imbalance == 1.07 and model.measured_ranks == 4 and model.free == 3
    assert max(model.residuals.values()) < 1e-12


@pytest.mark.parametrize("ranks", [24, 100, 4096])
def test_a_prediction_is_the_law_with_the_numbers_that_made_the_measurements(ranks):
    model, unseen = fit(MEASURED), synthetic(10_000_000, ranks)
    terms = of_model(model, NETWORK, 10_000_000, ranks)
    assert terms == pytest.approx(of_measurement(unseen, NETWORK), rel=1e-9)
    by_hand = (
        1.07 * unseen.compute
        + (unseen.messages + 9.0 * math.log2(ranks)) * 2e-6
        + (unseen.halo + unseen.gathered) / 5e9
    )
    assert terms.total == pytest.approx(by_hand, rel=1e-9)


def test_a_measurement_that_follows_no_law_shows_in_the_residual():
    measurements = [*MEASURED[:-1], synthetic(50653, 4, per_item=2.6e-6, halo=96.0)]
    model = fit(measurements)
    assert model.residuals["compute"] > 0.05 and model.residuals["halo"] > 0.05
    assert model.residuals["messages"] < 1e-12
    assert model.per_item != pytest.approx(KNOWN["per_item"], rel=1e-3)


def test_one_number_of_items_gives_no_time_of_a_step_by_itself():
    one_size = [synthetic(50653, ranks, per_step=0.0) for ranks in (1, 2, 4)]
    model = fit(one_size)
    assert model.per_step == 0.0 and model.free == 1
    assert model.per_item == pytest.approx(KNOWN["per_item"], rel=1e-9)
    assert model.per_halo_byte == pytest.approx(KNOWN["per_halo_byte"], rel=1e-9)


def test_a_component_that_gathers_all_rows_has_no_halo():
    gathers = [
        synthetic(n, p, halo=0.0, exchanges=0.0) for n in (10_000, 64_009) for p in (1, 2, 4)
    ]
    model = fit(gathers)
    assert (model.halo, model.exchanges, model.per_halo_byte) == (0.0, 0.0, 0.0)
    assert model.gathered == pytest.approx(0.3)
    assert model.per_step == pytest.approx(KNOWN["per_step"], rel=1e-9)


@pytest.mark.parametrize("few", [MEASURED[:2], [MEASURED[0], MEASURED[3], MEASURED[0]]])
def test_too_few_measurements_are_refused(few):
    with pytest.raises(ValueError, match="needs three measurements, on several numbers of ranks"):
        fit(few)


@pytest.mark.parametrize("seed", range(20))
def test_no_number_is_negative_and_none_nearer(seed):
    columns = np.random.default_rng(seed).normal(size=(6, 3))
    expected, _ = nnls(columns, np.ones(6))
    assert not_negative(columns) == pytest.approx(tuple(expected), abs=1e-9)


@pytest.mark.parametrize("dimensions", [1, 2, 3])
def test_parts_are_counted_as_those_of_a_halved_cube(dimensions):
    """Against a lattice of parts in which every face and corner is looked at."""
    for halvings in range(10):
        counts = [round(p) for p in parts(2**halvings, dimensions)]
        assert math.prod(counts) == 2**halvings
        centre = [(p - 1) // 2 for p in counts]
        places = np.stack(np.meshgrid(*map(np.arange, counts), indexing="ij"), -1)
        distance = np.abs(places.reshape(-1, dimensions) - centre)
        touching = distance[(distance.max(axis=1) == 1)]
        assert neighbours(2**halvings, dimensions) == len(touching)
        sides = 1.0 / np.array(counts)  # of a part of the unit cube
        face_neighbours = touching[touching.sum(axis=1) == 1]
        area = sum(math.prod(sides[row == 0]) for row in face_neighbours)
        items = 512.0  # of a part, so many more in the cube
        lattice = (items * 2**halvings) ** (1.0 - 1.0 / dimensions)
        assert faces(items, 2**halvings, dimensions) == pytest.approx(area * lattice)


def test_efficiencies_compare_with_one_rank():
    model = fit(MEASURED)
    assert strong_efficiency(model, NETWORK, 1e6, 1) == weak_efficiency(model, NETWORK, 1e6, 1) == 1
    ranks = (1, 2, 4, 24, 96, 512, 4096)
    for efficiency in (strong_efficiency, weak_efficiency):
        falling = [efficiency(model, NETWORK, 1e6, p) for p in ranks]
        assert all(a > b > 0.0 for a, b in pairwise(falling))
    ideal = fit([synthetic(n, p, 1.0, **dict.fromkeys((*COUNTED, "per_step"), 0.0))
                 for n in (8000, 50653) for p in (1, 2, 4)])  # fmt: skip
    assert strong_efficiency(ideal, NETWORK, 1e6, 4096) == pytest.approx(1.0)
    assert weak_efficiency(ideal, NETWORK, 1e6, 4096) == pytest.approx(1.0)


def test_a_slower_network_costs_what_its_messages_say():
    model = fit(MEASURED)
    fast = of_model(model, NETWORK, 1e6, 64)
    slow = of_model(model, Network(2e-5, 5e8), 1e6, 64)
    assert slow.compute == fast.compute
    assert slow[1:] == pytest.approx([10.0 * term for term in fast[1:]])


def test_a_run_is_scaled_to_the_step_that_it_took():
    model = fit(MEASURED)
    on_two_ranks = of_model(model, NETWORK, 1e6, 2)
    scaled = of_run(model, NETWORK, 1e6, on_two_ranks.total, 2, 64)
    assert scaled == pytest.approx(of_model(model, NETWORK, 1e6, 64))
    heavier = of_run(model, NETWORK, 1e6, on_two_ranks.total + on_two_ranks.compute, 2, 64)
    assert heavier.compute == pytest.approx(2.0 * scaled.compute) and heavier[1:] == scaled[1:]
    with pytest.raises(ValueError, match="must take longer than its messages"):
        of_run(model, NETWORK, 1e6, 1e-9, 2, 64)
