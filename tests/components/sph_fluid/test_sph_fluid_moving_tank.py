"""Fluid in a tank that moves, computed in the tank's frame: exact motions, work, and the clock."""

import math

import numpy as np
import pytest
from fluid_params import fluid_params

from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.component import outputs_of
from quintet.interfaces.errors import SceneError, StepError

SPACING = 0.05
BOX = ((-2.0, -2.0, -2.0), (2.0, 2.0, 2.0))
DROP = ((0.4, -0.1, 0.3), (0.6, 0.1, 0.5))  # far from all walls
SCHEMES = {"extrapolated": 4e-4, "symplectic": 1e-3}  # s, steps


def fluid_in(motion, **changes):
    """A fluid in a tank with a motion, by its keys."""
    tables = {f"boundary.motion.{key}": value for key, value in motion.items()}
    settings = {"spacing": SPACING, "sound_speed": 20.0, "boundary.walls": BOX, "fluid": [DROP]}
    return SphFluid(fluid_params(**(settings | changes | tables)))


def in_world(points, motion, time):
    """Places (n, 3) m of points of the tank in the world."""
    place = motion.trajectory.at(time).place
    axis, angle, point = motion.direction, place[3], np.array(motion.point)
    arm = points - point
    along = np.outer(arm @ axis, axis)
    turned = along + math.cos(angle) * (arm - along) + math.sin(angle) * np.cross(axis, arm)
    return point + place[:3] + turned


def centre(fluid):
    return fluid.state.position_density[: fluid.state.fluid, :3].mean(axis=0, keepdims=True)


def beside_parabola(name, scheme, dt):
    """How far [m] a drop is from where it would have fallen freely in the world in 0.3 s."""
    fluid = fluid_in(MOTIONS[name], integration=scheme, viscosity__artificial=0.0)
    motion, begin, end = fluid.params.boundary.motion, centre(fluid), 0.3
    rate = motion.trajectory.at(0.0).rate
    start = rate[:3] + np.cross(rate[3] * motion.direction, begin - np.array(motion.point))
    for _ in range(round(end / dt)):
        fluid.step(dt)
    fallen = begin + end * start + 0.5 * end**2 * np.array([0.0, 0.0, -9.81])
    return float(np.linalg.norm(in_world(centre(fluid), motion, end) - fallen))


MOTIONS = {
    "roll": {"period": 0.8, "angle_amplitude": 0.7, "axis": [0.3, 1.0, -0.2], "ramp": 0.2},
    "sway": {"period": 0.5, "amplitude": [0.1, -0.05, 0.08], "ramp": 0.1},
    "table": {
        "times": [0.0, 0.15, 0.3, 0.5],
        "displacement": [[0.0, 0.0, 0.0], [0.05, 0.0, 0.0], [0.05, 0.02, 0.1], [0.0, 0.0, 0.3]],
        "angle": [0.0, 0.3, 1.2, 1.5],
        "axis": [0.0, 0.0, 1.0],
        "point": [0.2, 0.1, 0.0],
    },
}


@pytest.mark.parametrize("name", MOTIONS)
@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_drop_in_a_moving_tank_falls_freely_in_the_world(name, scheme):
    """Euler's, Coriolis's and the centrifugal force, and gravity turned, against a parabola."""
    dt = SCHEMES[scheme]
    coarse, fine = beside_parabola(name, scheme, dt), beside_parabola(name, scheme, 0.5 * dt)
    assert fine < 2e-5
    assert coarse / fine == pytest.approx(4.0, rel=0.1)  # of second order


@pytest.mark.parametrize("name", MOTIONS)
@pytest.mark.parametrize("scheme", SCHEMES)
def test_energy_in_the_frame_of_the_tank_changes_by_the_work_of_its_motion(name, scheme):
    fluid = fluid_in(MOTIONS[name], integration=scheme, viscosity__artificial=0.0)
    dt, before = SCHEMES[scheme], fluid.totals()
    for _ in range(round(0.3 / dt)):
        fluid.step(dt)
    after = fluid.totals()
    kinds = ("kinetic", "potential", "internal")
    change = sum(getattr(after, kind) - getattr(before, kind) for kind in kinds)
    assert abs(after.work) > 0.1
    assert change == pytest.approx(after.work, abs=2e-3 * after.kinetic)


def test_a_tank_that_speeds_up_steadily_holds_fluid_as_inclined_gravity_does():
    """Exactly the equations of a tank at rest under the gravity that it has in its frame."""
    times = [0.0, 0.1, 0.2, 0.3]
    tank = {
        "boundary.walls": ((0.0, 0.0, 0.0), (1.0, 0.3, 0.6)),
        "boundary.method": "mdbc",
        "fluid": [((0.0, 0.0, 0.0), (1.0, 0.3, 0.3))],
        "density_diffusion": 0.1,
        "gauges.pressure_gauges": [[0.0, 0.15, 0.1], [1.0, 0.15, 0.0]],
    }
    motion = {"times": times, "displacement": [[0.5 * 2.0 * t * t, 0.0, 0.0] for t in times]}
    moving = fluid_in(motion, sound_speed=25.0, **tank)
    settings = {"spacing": SPACING, "sound_speed": 25.0, "gravity": (-2.0, 0.0, -9.81)}
    still = SphFluid(fluid_params(**settings, **tank))
    # Both start from the same pressure.
    start = moving.state.position_density.copy()
    still.state.position_density[:] = start
    still.state.velocity_pressure[:] = moving.state.velocity_pressure
    for _ in range(100):
        moving.step(4e-4)
        still.step(4e-4)
    for field in ("position_density", "velocity_pressure"):
        in_motion, at_rest = getattr(moving.state, field), getattr(still.state, field)
        assert in_motion == pytest.approx(at_rest, rel=1e-9, abs=1e-9)
    readings = outputs_of(moving)["pressure_gauge.pressure"]
    assert readings == pytest.approx(outputs_of(still)["pressure_gauge.pressure"], rel=1e-9)
    assert readings[0] > 0.0


POOL = {
    "boundary.walls": ((0.0, 0.0, 0.0), (0.4, 0.2, 0.4)),
    "boundary.method": "mdbc",
    "fluid": [((0.0, 0.0, 0.0), (0.4, 0.2, 0.2))],
    "gauges.pressure_gauges": [[0.0, 0.1, 0.1]],
}


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_saved_state_goes_on_with_the_same_bits(scheme):
    def make():
        return fluid_in(MOTIONS["roll"], integration=scheme, **POOL)

    first, second = make(), make()
    for _ in range(20):
        first.step(SCHEMES[scheme])
    second.load(first.save())
    assert (
        outputs_of(first)["pressure_gauge.pressure"]
        == outputs_of(second)["pressure_gauge.pressure"]
    )
    for _ in range(20):
        first.step(SCHEMES[scheme])
        second.step(SCHEMES[scheme])
    for name, array in first.save().items():
        assert np.array_equal(array, second.save()[name]), name
    assert first.totals().work == second.totals().work != 0.0


def test_the_motion_begins_anew_where_a_scene_begins_from_another_run():
    first, second = fluid_in(MOTIONS["roll"], **POOL), fluid_in(MOTIONS["roll"], **POOL)
    for _ in range(20):
        first.step(2e-4)
    second.begin_from(first.save())
    assert second.save()["motion"].tolist() == [0.0, 0.0]
    assert first.save()["motion"][0] == pytest.approx(4e-3)


def test_water_that_settled_in_a_tank_at_rest_can_begin_to_move():
    settings = {"spacing": SPACING, "sound_speed": 20.0, **POOL}
    still, moving = SphFluid(fluid_params(**settings)), fluid_in(MOTIONS["roll"], **POOL)
    still.step(2e-4)
    saved = still.save()
    assert "motion" not in saved
    moving.begin_from(saved)
    moving.step(2e-4)
    assert moving.save()["motion"][0] == 2e-4


def test_a_state_later_than_the_end_of_a_new_table_is_a_start():
    first = fluid_in(MOTIONS["roll"], **POOL)
    for _ in range(20):
        first.step(2e-4)
    rest = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]
    second = fluid_in({"times": [0.0, 1e-3], "displacement": rest}, **POOL)
    second.begin_from(first.save())
    second.step(2e-4)
    assert second.save()["motion"].tolist() == [2e-4, 0.0]


def test_a_step_beyond_the_table_is_refused():
    fluid = fluid_in({"times": [0.0, 1e-3], "displacement": [[0, 0, 0], [0, 0, 1e-6]]}, **POOL)
    for _ in range(5):
        fluid.step(2e-4)
    with pytest.raises(StepError, match=r"table ends at 0.001 s, and a step goes on to 0.0011 s"):
        fluid.step(2e-4)


def test_bodies_of_links_are_refused_in_a_moving_tank():
    fluid = fluid_in(MOTIONS["roll"], **POOL)
    static = {"normal": np.eye(3)[2:], "volume": np.full(1, 1e-4), "body": np.zeros(1)}
    with pytest.raises(
        SceneError, match="a link brings bodies that move in the frame of the world"
    ):
        fluid.bind({f"surface.{k}": v for k, v in static.items()}, frozenset({"surface"}))


def test_a_tank_at_rest_loads_nothing_of_motions():
    fluid = SphFluid(fluid_params(spacing=SPACING, sound_speed=20.0, **POOL))
    assert "motion" not in fluid.save()
    assert fluid.totals().work == 0.0
