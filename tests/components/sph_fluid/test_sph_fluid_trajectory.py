"""Places over time: splines through tables, harmonic motions, and inputs that are refused."""

import math

import numpy as np
import pytest
from fluid_params import fluid_params
from pydantic import ValidationError

from quintet.components.sph_fluid.setup.motion_table import read_motion
from quintet.components.sph_fluid.setup.trajectory import Harmonic, Spline

NONE = np.zeros(4)


def columns(times, *functions):
    """Places (n, 4) by functions of time; columns that are missing are 0."""
    places = np.zeros((len(times), 4))
    for axis, function in enumerate(functions):
        places[:, axis] = function(times)
    return places


def test_a_spline_meets_its_rows_and_is_exact_for_parabolas():
    times = np.array([0.0, 0.3, 0.4, 1.0, 1.7])
    places = columns(times, lambda t: 2.0 + 3.0 * t - 4.0 * t * t, lambda t: 0.5 * t)
    spline = Spline(times, places)
    for time in np.linspace(0.0, 1.7, 30):
        instant = spline.at(time)
        assert instant.place[:2] == pytest.approx([2 + 3 * time - 4 * time**2, 0.5 * time])
        assert instant.rate[:2] == pytest.approx([3.0 - 8.0 * time, 0.5])
        assert instant.second[:2] == pytest.approx([-8.0, 0.0], abs=1e-11)


def test_velocity_and_acceleration_of_a_spline_are_continuous_at_its_rows():
    random = np.random.default_rng(3)
    times = np.cumsum(random.uniform(0.1, 1.0, 12)) - 0.5
    spline = Spline(times, random.normal(size=(12, 4)))
    for time in times[1:-1]:
        before, after = spline.at(time - 1e-9), spline.at(time + 1e-9)
        for left, right in zip(before, after, strict=True):
            assert left == pytest.approx(right, abs=1e-5)


def test_the_error_of_a_spline_falls_with_the_fourth_power_of_the_step():
    def error(rows):
        times = np.linspace(0.0, 2.0, rows)
        spline = Spline(times, columns(times, np.sin))
        middle = np.linspace(0.8, 1.2, 50)
        return max(abs(spline.at(t).place[0] - math.sin(t)) for t in middle)

    assert error(21) / error(41) == pytest.approx(16.0, rel=0.1)


def test_two_rows_make_a_line():
    spline = Spline(np.array([0.0, 2.0]), np.array([[0.0] * 4, [1.0, 2.0, 3.0, 4.0]]))
    assert spline.at(0.5).place == pytest.approx([0.25, 0.5, 0.75, 1.0])
    assert spline.at(0.5).rate == pytest.approx([0.5, 1.0, 1.5, 2.0])
    assert spline.at(0.5).second == pytest.approx(NONE)


def test_two_equal_rows_at_an_end_mean_rest_there():
    times = np.array([0.0, 1.0, 1.2, 1.5])
    spline = Spline(times, columns(times, lambda t: np.array([0.0, 0.0, 0.1, 0.1])))
    assert spline.at(0.0).rate == pytest.approx(NONE)
    assert spline.at(1.5).rate == pytest.approx(NONE)


@pytest.mark.parametrize("begin", [0.0, -0.7])
def test_a_course_holds_the_extremes_of_a_spline_between_its_rows(begin):
    random = np.random.default_rng(7)
    times = np.cumsum(random.uniform(0.1, 1.0, 9))
    times += begin - times[0]
    spline = Spline(times, random.normal(size=(9, 4)))
    fine = np.array([spline.at(time).place for time in np.linspace(0.0, spline.end, 20001)])
    course = spline.course()
    assert course.min(axis=0) == pytest.approx(fine.min(axis=0), abs=1e-6)
    assert course.max(axis=0) == pytest.approx(fine.max(axis=0), abs=1e-6)
    assert (course.min(axis=0) <= fine.min(axis=0) + 1e-12).all()


def test_a_course_of_a_harmonic_motion_reaches_its_amplitudes():
    course = Harmonic(np.array([0.1, 0.0, -0.2, 0.3]), 0.9, 0.5).course()
    assert course.max(axis=0) == pytest.approx([0.1, 0.0, 0.2, 0.3])
    assert course.min(axis=0) == pytest.approx([-0.1, 0.0, -0.2, -0.3])


@pytest.mark.parametrize("ramp", [0.0, 0.7])
def test_rates_of_a_harmonic_motion_are_those_of_its_place(ramp):
    motion, dt = Harmonic(np.array([0.1, 0.0, -0.2, 0.3]), 0.9, ramp), 1e-5
    for time in (0.05, 0.3, 0.69, 0.71, 2.0):
        ends = motion.at(time - dt), motion.at(time + dt)
        instant = motion.at(time)
        assert (ends[1].place - ends[0].place) / (2 * dt) == pytest.approx(instant.rate, rel=1e-6)
        assert (ends[1].rate - ends[0].rate) / (2 * dt) == pytest.approx(instant.second, rel=1e-6)


def test_a_ramp_starts_from_rest_and_ends_without_a_jump():
    motion = Harmonic(np.array([0.1, 0.0, 0.0, 0.0]), 0.9, 0.7)
    assert all(part == pytest.approx(NONE) for part in motion.at(0.0))
    for left, right in zip(motion.at(0.7 - 1e-9), motion.at(0.7), strict=True):
        assert left == pytest.approx(right, abs=1e-6)


def test_a_table_has_units_in_its_heads(tmp_path):
    file = tmp_path / "roll.csv"
    file.write_text("time [ms], x [mm], angle [deg]\n0, 1, 0\n500, 2, 90\n")
    times, places = read_motion(str(file))
    assert times == pytest.approx([0.0, 0.5])
    assert places == pytest.approx(np.array([[1e-3, 0, 0, 0], [2e-3, 0, 0, 0.5 * math.pi]]))


def test_a_table_without_units_is_in_si(tmp_path):
    file = tmp_path / "sway.csv"
    file.write_text("z,time\n0.5,0\n0.25,2\n")
    times, places = read_motion(str(file))
    assert times == pytest.approx([0.0, 2.0])
    assert places[:, 2] == pytest.approx([0.5, 0.25])


@pytest.mark.parametrize(
    ("text", "match"),
    [
        ("time,x\n0,a\n", "then lines of numbers"),
        ("t,x\n0,1\n1,2\n", "must have columns time and one or more of x, y, z, angle"),
        ("time,x,x\n0,1,1\n1,2,1\n", "each once"),
        ("time\n0\n1\n", "one or more of x, y, z, angle"),
        ("time,x\n0,1\n1,nan\n", "2 finite numbers in each of its lines"),
        ("time,angle [turnip]\n0,1\n1,2\n", "the unit of '1 turnip' is not known"),
        ("time,angle [m]\n0,1\n1,2\n", "column angle must be in rad"),
    ],
)
def test_a_wrong_table_is_refused(tmp_path, text, match):
    file = tmp_path / "wrong.csv"
    file.write_text(text)
    with pytest.raises(ValueError, match=match):
        read_motion(str(file))


TANK = {
    "boundary.walls": ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)),
    "fluid": (((0.0, 0.0, 0.0), (1.0, 1.0, 0.3)),),
}
ROLL = {"period": 1.0, "angle_amplitude": 0.1}
TIMES = {"times": [0.0, 1.0, 2.0]}
SWAY = [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.0, 0.0]]


def params_with_motion(motion, **changes):
    tables = {f"boundary.motion.{key}": value for key, value in motion.items()}
    return fluid_params(spacing=0.1, sound_speed=40.0, **(TANK | changes | tables))


@pytest.mark.parametrize(
    ("motion", "match"),
    [
        ({}, "one of file, times and period; found none"),
        ({"point": [0.0, 0.0, 0.0]}, "one of file, times and period; found none"),
        (TIMES | {"period": 1.0}, "found times and period"),
        ({"period": 1.0, "angle": [1.0]}, "motion.angle belongs to times"),
        (TIMES | {"displacement": SWAY, "ramp": 1.0}, "amplitude, angle_amplitude and ramp belong"),
        (TIMES | {"displacement": SWAY[:2]}, "a row for each of the 3 times; found 2"),
        (TIMES, "motion.times needs displacement or angle"),
        ({"period": 1.0}, "motion.period needs an amplitude or an angle_amplitude"),
        ({"times": [0.0], "displacement": SWAY[:1]}, "must be 2 or more, increase"),
        ({"times": [0.0, 0.0], "displacement": SWAY[:2]}, "increase, and begin at 0 s"),
        ({"times": [0.5, 1.0], "displacement": SWAY[:2]}, "begin at 0 s or before"),
        (ROLL, "motion.axis is needed, as there is an angle"),
        (ROLL | {"axis": [0.0, 0.0, 0.0]}, "motion.axis must be a direction"),
    ],
)
def test_a_motion_that_says_too_little_or_too_much_is_refused(motion, match):
    if not motion:
        motion = {"axis": [0.0, 1.0, 0.0]}
    with pytest.raises(ValidationError, match=match):
        params_with_motion(motion)


Y, X = [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]


@pytest.mark.parametrize(
    ("motion", "changes", "match"),
    [
        (ROLL | {"axis": X}, {"dimensions": 2}, "in the plane of x and z in two dimensions"),
        ({"period": 1.0, "amplitude": Y}, {"dimensions": 2}, "found displacements along y"),
        (ROLL | {"axis": Y}, {"boundary.symmetry": ["x-"]}, "plane of boundary.symmetry x-"),
        (
            {"period": 1.0, "amplitude": X},
            {"boundary.symmetry": ["x-"]},
            "displaced by nothing along x",
        ),
        (ROLL | {"axis": Y}, {"boundary.walls": None}, "needs walls, obstacles or meshes"),
    ],
)
def test_a_motion_that_the_tank_cannot_follow_is_refused(motion, changes, match):
    with pytest.raises(ValidationError, match=match):
        params_with_motion(motion, **changes)


@pytest.mark.parametrize(
    ("motion", "changes"),
    [
        (ROLL | {"axis": [0.0, -2.0, 0.0]}, {"dimensions": 2}),
        (ROLL | {"axis": Y}, {"boundary.symmetry": ["y-"]}),
        ({"period": 1.0, "amplitude": X}, {"boundary.symmetry": ["y-", "y+"]}),
    ],
)
def test_motions_in_the_plane_are_taken(motion, changes):
    assert params_with_motion(motion, **changes).boundary.motion.trajectory.at(0.3)
