"""Buffers of inflows and outflows: they are no part of the fluid, and states keep them."""

import re
from typing import Any

import numpy as np
import pytest
from tubes import LENGTH, MASS, SPACING, SPEED, run, tube

from quintet.components.sph_fluid.component import SphFluid
from quintet.components.sph_fluid.open_boundaries import flow
from quintet.components.sph_fluid.open_boundaries.kernels import near_rows
from quintet.interfaces.component import outputs_of
from quintet.interfaces.errors import SceneError, StepError

INFLOW, OUTFLOW = {"face": "x-", "speed": SPEED}, {"face": "x+"}


def with_buffers(inflow: list[dict[str, Any]], outflow: list[dict[str, Any]]) -> SphFluid:
    return tube(**{"boundary.inflow": inflow, "boundary.outflow": outflow})


@pytest.mark.parametrize(
    ("saved_buffers", "new_buffers", "words"),
    [
        (([INFLOW], [OUTFLOW]), ([INFLOW], []), "order, inflow x-; found inflow x-, outflow x+."),
        (([INFLOW], []), ([INFLOW], [OUTFLOW]), "order, inflow x-, outflow x+; found inflow x-."),
        (([], []), ([INFLOW], [OUTFLOW]), "order, inflow x-, outflow x+; found none."),
        (([INFLOW], [OUTFLOW]), ([], []), "order, none; found inflow x-, outflow x+."),
        (
            ([INFLOW], [OUTFLOW]),
            ([{"face": "x+", "speed": SPEED}], [{"face": "x-"}]),
            "order, inflow x+, outflow x-; found inflow x-, outflow x+.",
        ),
    ],
)
def test_a_state_with_buffers_at_other_faces_is_refused(
    saved_buffers: Any, new_buffers: Any, words: str
) -> None:
    saved, restarted = with_buffers(*saved_buffers), with_buffers(*new_buffers)
    saved.step(1e-4)
    with pytest.raises(SceneError, match=re.escape(words)):
        restarted.begin_from(saved.save())


def test_books_begin_again_with_a_run_that_begins_from_another() -> None:
    inflow = {"boundary.inflow": [{"face": "x-", "speed": 1.2 * SPEED}]}
    fluid, restarted = tube(**inflow), tube(**inflow)
    run(fluid, 0.4)
    assert fluid.state.passed.min() > 0
    assert fluid.totals().work == MASS * fluid.state.carried != 0.0
    restarted.begin_from(fluid.save())
    count = int((restarted.state.role == 0).sum())
    balance, outputs = restarted.totals().mass_balance, outputs_of(restarted)
    assert balance.pop("at the start") == pytest.approx(count * MASS)
    assert set(balance.values()) == {0.0}
    assert restarted.totals().work == 0.0
    assert [outputs[f"mass_gauge.{name}"] for name in ("entered", "left", "imbalance")] == [0, 0, 0]
    run(restarted, 0.2)
    totals = restarted.totals()
    assert sum(totals.mass_balance.values()) == pytest.approx(totals.mass, rel=1e-13)
    assert outputs_of(restarted)["mass_gauge.entered"] > 0.0


def test_the_books_alone_differ_from_a_run_without_interruption() -> None:
    fluid, restarted = tube(), tube()
    run(fluid, 0.2)
    restarted.begin_from(fluid.save())
    for solver in (fluid, restarted):
        run(solver, 0.2)
    restarted_state = restarted.save()
    differing = {
        name for name, array in fluid.save().items() if (restarted_state[name] != array).any()
    }
    assert differing <= {"at_start", "passed", "carried", "judged"}


def test_a_state_of_more_fluid_is_refused_with_the_number_that_there_was() -> None:
    fluid = tube(**{"boundary.inflow": [], "boundary.outflow": []})
    smaller = tube(
        **{
            "boundary.inflow": [],
            "boundary.outflow": [],
            "fluid": [[[0.0, 0.0, 0.0], [1.0, 1.0, 0.5]]],
        }
    )
    state = {name: np.array(array) for name, array in fluid.save().items()}
    with pytest.raises(SceneError, match="with 200 particles or fewer at the start; found 400"):
        smaller.begin_from(state)


def test_a_state_of_other_walls_is_refused() -> None:
    fluid = tube()
    longer = tube(**{"boundary.walls": [[0.0, 0.0, 0.0], [LENGTH + 0.5, 1.0, 0.5]]})
    words = r"must be of its \d+ wall and surface particles; found \d+\. Make spacing, walls"
    with pytest.raises(SceneError, match=words):
        longer.begin_from(fluid.save())


def test_speed_and_front_are_of_the_fluid_without_buffers() -> None:
    fluid = tube(**{"gauges.motion_gauge": True, "gauges.front_gauge": "x"})
    run(fluid, 0.05)
    buffer_rows = np.flatnonzero(fluid.state.role)
    free_rows = np.flatnonzero(fluid.state.role == 0)
    fluid.state.velocity_pressure[buffer_rows, 0] = 9.0
    outputs = outputs_of(fluid)
    assert outputs["motion_gauge.speed"] < 1.1 * SPEED
    furthest = fluid.state.position_density[free_rows, 0].max()
    assert outputs["front_gauge.position"] == pytest.approx(furthest + 0.5 * SPACING, abs=1e-12)
    assert furthest < fluid.state.position_density[buffer_rows, 0].max() - 3.0 * SPACING


def test_the_density_filter_leaves_buffers_alone() -> None:
    fluid = tube(**{"shepard_every": 1})
    run(fluid, 0.02)
    in_buffer = fluid.state.role > 0
    rows = np.flatnonzero(in_buffer)
    fluid.state.position_density[rows, 3] = 1007.0
    before = fluid.state.position_density[: fluid.state.fluid, 3].copy()
    assert fluid.filter is not None
    fluid.filter.apply(fluid.state, fluid.lists.arrays, fluid.team)
    after = fluid.state.position_density[: fluid.state.fluid, 3]
    assert (after[in_buffer] == 1007.0).all()
    assert (after[~in_buffer] != before[~in_buffer]).any()


def test_samples_of_bodies_in_buffers_end_the_run() -> None:
    fluid = tube()
    clear_point, buffer_point = [1.0, 0.5, 0.2], [LENGTH - 0.1, 0.5, 0.2]
    fluid.open_boundaries.refuse_samples(np.array([clear_point]))
    words = r"buffer of outflow x\+, 0\.25 m from its face; found 1 of 2 surface samples in it"
    with pytest.raises(StepError, match=words):
        fluid.open_boundaries.refuse_samples(np.array([clear_point, buffer_point]))


def test_rows_near_points_are_those_within_reach_in_order() -> None:
    generator = np.random.default_rng(1)
    position, points = generator.random((300, 4)), generator.random((7, 2, 3))
    begin, rows = near_rows(points, position, 0.3)
    for number, point in enumerate(points.reshape(-1, 3)):
        distance = np.linalg.norm(position[:, :3] - point, axis=1)
        expected = np.flatnonzero(distance < 0.3)
        assert rows[begin[number] : begin[number + 1]].tolist() == expected.tolist()
    begin, rows = near_rows(points, position[:0], 0.3)
    assert not begin.any()
    assert not len(rows)


def test_layers_of_an_inflow_share_fits_and_a_hydrostatic_one_needs_none(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fits: list[int] = []

    def count_fits(points: Any, position: Any, reach: float) -> Any:
        fits.append(len(points))
        return near_rows(points, position, reach)

    monkeypatch.setattr(flow, "near_rows", count_fits)
    fluid = tube(**{"boundary.outflow": []})
    assert fits == [10]
    assert int((fluid.state.role == 1).sum()) == 50
    tube(**{"boundary.outflow": [], "boundary.inflow": [{**INFLOW, "density": "hydrostatic"}]})
    assert fits == [10]
