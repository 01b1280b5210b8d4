"""Inflow and outflow: particles that enter and leave, and the flow between."""

import re
from typing import Any

import numpy as np
import pytest
from fluid_params import nested
from tubes import LENGTH, MASS, SPACING, SPEED, TUBE, params_of, run, tube

from quintet.components.sph_fluid import SphFluidParams
from quintet.components.sph_fluid.component import SphFluid
from quintet.components.sph_fluid.open_boundaries.zones import zones
from quintet.interfaces.component import Resources, outputs_of
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import read


def balance(fluid: SphFluid) -> dict[str, float]:
    totals = fluid.totals()
    assert sum(totals.mass_balance.values()) == pytest.approx(totals.mass, rel=1e-13)
    assert outputs_of(fluid)["mass_gauge.imbalance"] == 0.0
    return {reason: mass / MASS for reason, mass in totals.mass_balance.items()}


def test_uniform_motion_goes_through_the_tube_unchanged() -> None:
    """As much enters as leaves, and each particle comes and goes once."""
    fluid = tube()
    before = fluid.totals()
    run(fluid, 3.0)
    counts = balance(fluid)
    through = SPEED * 3.0 * 0.5 / SPACING**2  # particles
    assert counts["entered by the inflow x-"] == pytest.approx(through, rel=0.03)
    assert counts["left by the outflow x+"] == pytest.approx(-through, rel=0.03)
    assert set(counts) == {
        "at the start",
        "entered by the inflow x-",
        "left by the outflow x+",
    }
    assert fluid.totals().mass == pytest.approx(before.mass, rel=0.02)
    velocity = fluid.view()["velocity"]
    assert velocity[:, 0] == pytest.approx(SPEED, abs=0.01 * SPEED)
    assert np.abs(velocity[:, 2]).max() < 0.01 * SPEED
    assert np.abs(fluid.view()["density"] - 1000.0).max() < 1.0
    identity = fluid.state.identity
    assert len(np.unique(identity)) == len(identity)
    assert identity.max() == fluid.state.born - 1


def test_gauges_read_the_flow() -> None:
    fluid = tube()
    run(fluid, 0.5)
    outputs = outputs_of(fluid)
    assert outputs["discharge_gauge.discharge"] == pytest.approx(SPEED * 0.5, rel=0.01)
    velocity = outputs["velocity_gauge.velocity"]
    assert velocity[:2] == pytest.approx(np.tile([SPEED, 0.0, 0.0], (2, 1)), abs=0.01 * SPEED)
    assert not velocity[2].any(), "there is no fluid"


def test_particles_of_buffers_are_no_part_of_the_fluid() -> None:
    fluid = tube()
    entrance, exit_ = zones(fluid.params)
    between = LENGTH - entrance.length - exit_.length
    assert fluid.totals().mass == pytest.approx(1000.0 * 0.5 * between, rel=1e-9)
    assert fluid.totals().kinetic == pytest.approx(0.5 * fluid.totals().mass * SPEED**2)
    assert fluid.items() > fluid.totals().mass / MASS


@pytest.mark.parametrize("integration", ["extrapolated", "symplectic"])
@pytest.mark.parametrize("xsph", [0.0, pytest.param(0.2, marks=pytest.mark.full)])
def test_threads_and_a_saved_state_change_no_bit(integration: str, xsph: float) -> None:
    changes = {"integration": integration, "xsph": xsph, "boundary.outflow": [{"face": "x+"}]}
    fluid, loaded = tube(**changes), tube(**changes)
    shared = SphFluid(fluid.params, Resources(2))
    for solver in (fluid, shared):
        run(solver, 0.3)
    loaded.load(fluid.save())
    for solver in (fluid, shared, loaded):
        run(solver, 0.3)
    assert fluid.state.passed.min() > 0
    for solver in (shared, loaded):
        for name, array in fluid.save().items():
            assert np.array_equal(solver.save()[name], array), name


def test_a_run_begins_from_a_state_with_more_fluid() -> None:
    fluid = tube(**{"boundary.outflow": [], "boundary.open_faces": ["x-", "x+"]})
    run(fluid, 0.4)
    restarted = tube(**{"boundary.outflow": [], "boundary.open_faces": ["x-", "x+"]})
    assert fluid.items() > restarted.items()
    restarted.begin_from(fluid.save())
    assert restarted.items() == fluid.items()


def test_an_inflow_may_have_a_profile_by_formula_or_table(tmp_path: Any) -> None:
    table = tmp_path / "profile.csv"
    table.write_text("z, u\n0.0, 0.0\n0.5, 1.0\n")
    speeds = []
    for changes in ({"speed": "2 * z"}, {"table": str(table)}):
        fluid = tube(**{"boundary.inflow": [{"face": "x-", **changes}]})
        in_buffer = fluid.state.role == 1
        z, u = fluid.state.position_density[: fluid.state.fluid, 2], fluid.state.velocity_pressure
        assert u[: fluid.state.fluid][in_buffer, 0] == pytest.approx(2.0 * z[in_buffer])
        speeds.append(u[: fluid.state.fluid][in_buffer, 0])
    assert speeds[0] == pytest.approx(speeds[1])


def test_flow_may_go_the_other_way() -> None:
    changes = {
        "boundary.inflow": [{"face": "x+", "speed": SPEED}],
        "boundary.outflow": [{"face": "x-"}],
        "initial.velocity": [-SPEED, "0", "0"],
    }
    forward, backward = tube(), tube(**changes)
    for solver in (forward, backward):
        run(solver, 1.0)
    forward_balance, backward_balance = balance(forward), balance(backward)
    assert list(forward_balance.values()) == pytest.approx(list(backward_balance.values()), abs=10)
    assert outputs_of(backward)["discharge_gauge.discharge"] == pytest.approx(
        -SPEED * 0.5, rel=0.01
    )


def test_a_level_bears_the_water_at_both_ends() -> None:
    """Water with a surface flows through slowly, and stands as high as its outflow says."""
    changes = {
        "gravity": [0.0, 0.0, -9.81],
        "sound_speed": 25.0,
        "viscosity.artificial": 0.1,
        "boundary.open_faces": ["x-", "x+", "z+"],
        "boundary.walls": [[0.0, 0.0, 0.0], [LENGTH, 1.0, 0.8]],
        "boundary.inflow": [{"face": "x-", "speed": SPEED, "level": 0.5}],
        "boundary.outflow": [{"face": "x+", "level": 0.5}],
        "gauges.level_gauges": [[1.0, 0.5]],
        "gauges.pressure_gauges": [[1.0, 0.5, 0.0]],
    }
    fluid = tube(**changes)
    run(fluid, 2.0)
    outputs = outputs_of(fluid)
    assert outputs["level_gauge.height"] == pytest.approx(0.5, abs=0.6 * SPACING)
    assert outputs["pressure_gauge.pressure"] == pytest.approx(9810.0 * 0.5, rel=0.1)
    assert outputs["discharge_gauge.discharge"] == pytest.approx(SPEED * 0.5, rel=0.06)
    balance(fluid)


def test_an_inflow_may_be_as_dense_as_water_at_rest() -> None:
    inflow = {"face": "x-", "speed": SPEED, "level": 0.5, "density": "hydrostatic"}
    fluid = tube(**{"gravity": [0.0, 0.0, -9.81], "sound_speed": 25.0, "boundary.inflow": [inflow]})
    run(fluid, 0.02)
    rows = np.flatnonzero(fluid.state.role == 1)
    z, density = fluid.state.position_density[rows, 2:].T
    pressure = fluid.state.velocity_pressure[rows, 3] * density**2
    assert pressure == pytest.approx(9810.0 * (0.5 - z), rel=1e-9)


def test_an_outflow_keeps_its_pressure() -> None:
    """Fluid that starts at this pressure keeps it, up to the inflow.

    With Wendland's kernel; under pressure the cubic spline lets particles leave their rows.
    """
    density = 1000.0 * (1.0 + 7.0 * 1000.0 / (10.0**2 * 1000.0)) ** (1.0 / 7.0)  # Tait
    outflow = [{"face": "x+", "pressure": 1000.0}]
    changes = {"boundary.outflow": outflow, "initial.density": density, "kernel": "wendland"}
    fluid = tube(**changes)
    run(fluid, 2.0)
    assert fluid.view()["pressure"] == pytest.approx(1000.0, rel=0.02)


def test_fluid_that_is_driven_back_into_an_inflow_has_left() -> None:
    fluid = tube()
    state = {name: np.array(array) for name, array in fluid.save().items()}
    row = int(np.flatnonzero(state["role"] == 0)[0])
    state["position_density"][row, :3] = [0.5 * SPACING, 0.5, 0.25]
    fluid.load(state)
    fluid.step(1e-5)
    assert balance(fluid)["driven back into an inflow"] == pytest.approx(-1.0)
    assert outputs_of(fluid)["mass_gauge.left"] == pytest.approx(MASS)


def test_what_a_buffer_holds_is_not_lost_again() -> None:
    fluid = tube()
    state = {name: np.array(array) for name, array in fluid.save().items()}
    row = int(np.flatnonzero(state["role"] == 2)[0])
    state["position_density"][row, 2] = -2.0
    fluid.load(state)
    fluid.step(1e-5)
    assert balance(fluid)["at the start"] == pytest.approx(fluid.state.at_start)
    assert fluid.state.lost == 0


INFLOW = {"face": "x-", "speed": 1.0}


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"boundary.walls": None}, "boundary.inflow x- must be an open face of the tank"),
        ({"boundary.open_faces": ["x-"]}, r"boundary.outflow x\+ must be an open face"),
        (
            {"boundary.inflow": [{"face": "y-", "speed": 1.0}],
             "boundary.open_faces": ["y-", "x+"]},
            "must be across x or z in two dimensions",
        ),
        ({"boundary.inflow": [INFLOW, INFLOW]}, "must be the only inflow or outflow of its face"),
        ({"boundary.outflow": [{"face": "x-"}]}, "must be the only inflow or outflow"),
        ({"boundary.inflow": [{**INFLOW, "level": 2.0}]}, "level must be a height in the tank"),
        ({"boundary.inflow": [{"face": "x-"}]}, "must have either speed or table; found neither"),
        ({"boundary.inflow": [{"face": "x-", "speed": -1.0}]}, "speed must be 0 or more, into"),
        (
            {"boundary.outflow": [{"face": "x+", "level": 0.4, "pressure": 1.0}]},
            "must have level or pressure, or neither; found both",
        ),
        (
            {"boundary.walls": [[0.0, 0.0, 0.0], [0.75, 1.0, 0.5]],
             "fluid": [[[0.0, 0.0, 0.0], [0.75, 1.0, 0.5]]]},
            "for the buffers of inflows and outflows, 0.25 m each",
        ),
        (
            {"boundary.obstacles": [[[0.1, 0.0, 0.0], [0.4, 1.0, 0.2]]],
             "fluid": [[[0.5, 0.0, 0.0], [LENGTH, 1.0, 0.5]]]},
            r"obstacles\[0\] must stand outside of the buffers",
        ),
        (
            {"boundary.outflow": [{"face": "z+"}], "boundary.open_faces": ["x-", "z+"]},
            r"must all be across the same axis, .* found x-, z\+\. Move them to one face or to two",
        ),
        (
            {"boundary.outflow": [{"face": "x+", "pressure": -100.0}], "negative_pressure": False},
            r"pressure must be from 0 to 1\.355e\+04 Pa, .* found -100 Pa\. Raise it, or set neg",
        ),
        (
            {"boundary.outflow": [{"face": "x+", "pressure": -2e4}]},
            r"pressure must be from -7453 to 1\.355e\+04 Pa, .* found -20000 Pa\. Raise it\.",
        ),
        (
            {"boundary.outflow": [{"face": "x+", "pressure": 2e4}]},
            r"densities within 10 % of 1000 .* found 20000 Pa\. Raise sound_speed, or lower the p",
        ),
    ],
)  # fmt: skip
def test_what_cannot_flow_is_refused(changes: dict[str, Any], words: str) -> None:
    params, mistakes = read(SphFluidParams, nested(TUBE | changes), "water")
    assert params is None
    assert any(re.search(words, mistake) for mistake in mistakes), mistakes


def test_a_table_without_speeds_is_refused(tmp_path: Any) -> None:
    table = tmp_path / "profile.csv"
    table.write_text("z, v\n0.0, 0.0\n0.5, 1.0\n")
    changes = {"boundary.inflow": [{"face": "x-", "table": str(table)}]}
    _, mistakes = read(SphFluidParams, nested(TUBE | changes), "water")
    assert "table must have a column u [m/s], into the tank" in mistakes[0]


def test_several_ranks_are_refused() -> None:
    class Several:
        size, rank = 2, 0

    with pytest.raises(SceneError, match=r"boundary.inflow must be empty of a fluid on 2 ranks"):
        SphFluid(params_of(TUBE), Resources(communicator=Several()))
