"""Mooring lines as a component: loads about the centre of mass, refusals, restarts."""

import numpy as np
import pytest

from quintet.components.mooring_lines.component import MooringLines
from quintet.components.mooring_lines.params import MooringLinesParams
from quintet.interfaces.errors import SceneError, StepError
from quintet.interfaces.params import read

STRAIGHT = {"anchor": [0.0, 0.0, 0.0], "fairlead": [3.0, 4.0, 0.0], "length": 4.0, "stiffness": 8e3}
CHAIN = {**STRAIGHT, "fairlead": [3.0, 0.0, 2.0], "weight": 20.0}
WANTED = frozenset({"load.force", "load.torque", "line_gauge.tension", "line_gauge.lying"})


def motion(position=(2.0, 4.0, 0.0), turn=(1.0, 0.0, 0.0, 0.0), velocity=(0.0, 0.0, 0.0)):
    """Motion of one body; it does not rotate."""
    return {
        "motion.position": np.array([position]),
        "motion.velocity": np.array([velocity]),
        "motion.orientation": np.array([turn]),
        "motion.angular_velocity": np.zeros((1, 3)),
    }


def lines_of(*lines, bodies=1, **start):
    """Lines that are fast to a body."""
    component = MooringLines(read(MooringLinesParams, {"lines": list(lines)}, "chains")[0])
    component.bind({"motion.mass": np.ones(bodies)}, frozenset({"motion", "load"}))
    component.prime(motion(**start))
    return component


def load_of(component, **moved):
    component.take(motion(**moved))
    component.step(1e-3)
    return component.give(WANTED)


def test_a_straight_line_pulls_at_the_fairlead():
    fields = load_of(lines_of(STRAIGHT))
    tension = 8e3 * (5.0 / 4.0 - 1.0)
    force = -tension * np.array([0.6, 0.8, 0.0])
    assert fields["load.force"][0] == pytest.approx(force)
    assert fields["load.torque"][0] == pytest.approx(np.cross([1.0, 0.0, 0.0], force))
    assert fields["line_gauge.tension"] == pytest.approx([tension])


def test_a_fairlead_turns_with_its_body():
    quarter = (np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5))  # about z: the arm (1, 0, 0) is (0, 1, 0)
    turned = load_of(lines_of(STRAIGHT), turn=quarter)
    distance = np.hypot(2.0, 5.0)
    force = -8e3 * (distance / 4.0 - 1.0) * np.array([2.0, 5.0, 0.0]) / distance
    assert turned["load.force"][0] == pytest.approx(force)
    assert turned["load.torque"][0] == pytest.approx(np.cross([0.0, 1.0, 0.0], force))
    # A body that is turned as the run begins has its line where the scene says.
    begun = load_of(lines_of(STRAIGHT, turn=quarter), turn=quarter)
    assert begun["load.force"][0] == pytest.approx(-2e3 * np.array([0.6, 0.8, 0.0]))


def test_loads_of_several_lines_add_up_on_their_bodies():
    other = {**STRAIGHT, "anchor": [6.0, 8.0, 0.0]}
    fields = load_of(lines_of(STRAIGHT, other))
    assert fields["load.force"][0] == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)
    assert fields["load.torque"][0] == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)


def test_the_energy_is_the_work_of_a_turn():
    """Of an arm of 1 m that turns about y at 1 rad/s for 0.5 rad, in steps of a hundredth."""
    component, work, dt = lines_of(CHAIN, position=(2.0, 0.0, 2.0)), 0.0, 0.01
    rate = {"motion.angular_velocity": np.array([[0.0, -1.0, 0.0]])}
    before = component.totals().potential
    for step in range(50):
        half = -0.5 * (step + 0.5) * dt
        turn = (np.cos(half), 0.0, np.sin(half), 0.0)
        component.take(motion(position=(2.0, 0.0, 2.0), turn=turn) | rate)
        component.step(dt)
        work += dt * float(component.give(WANTED)["load.torque"][0, 1])
    assert component.totals().potential - before == pytest.approx(work, rel=1e-3)


def test_the_energy_is_the_work_done_on_the_lines():
    """Along a path of 50 steps; each load is that of the middle of its step."""
    taut, end, work, dt = {**CHAIN, "weight": 0.0}, np.array([3.0, 0.0, 2.0]), 0.0, 0.02
    component = lines_of(CHAIN, taut, position=tuple(end))
    before = component.totals().potential
    for step in range(50):
        velocity = np.array([1.0, 0.3, 0.2 * np.cos(0.1 * step)])
        middle, end = end + 0.5 * dt * velocity, end + dt * velocity
        component.take(motion(position=tuple(middle), velocity=tuple(velocity)))
        component.step(dt)
        work -= dt * float(component.give(WANTED)["load.force"][0] @ velocity)
    assert component.totals().potential - before == pytest.approx(work, rel=2e-4)


def test_a_line_of_a_body_that_is_missing_is_refused():
    with pytest.raises(SceneError, match=r"lines.0.body must be below 1, .* found 3. Correct it."):
        lines_of({**STRAIGHT, "body": 3})


def test_a_link_of_motion_without_loads_is_refused():
    component = MooringLines(read(MooringLinesParams, {"lines": [STRAIGHT]}, "chains")[0])
    with pytest.raises(SceneError, match="both motion and load of mooring lines; load has no"):
        component.bind({"motion.mass": np.ones(1)}, frozenset({"motion"}))


def test_a_fairlead_below_the_bed_is_refused_and_ends_a_run():
    sunken = {**CHAIN, "fairlead": [3.0, 0.0, -0.5]}
    _, (mistake,) = read(MooringLinesParams, {"lines": [sunken]}, "chains")
    assert (
        "fairlead must not be below the bed, which is at the height of the anchor; found it 0.5"
        in mistake
    )
    component = lines_of(CHAIN, position=(3.0, 0.0, 2.0))
    with pytest.raises(StepError, match=r"line 0, at 0.001 s: its fairlead is 0.2 m below the bed"):
        load_of(component, position=(3.0, 0.0, -0.2))
    free = lines_of({**CHAIN, "on_bed": False}, position=(3.0, 0.0, 2.0))
    assert load_of(free, position=(3.0, 0.0, -0.2))["line_gauge.lying"] == 0.0


def test_a_line_that_is_stretched_too_far_is_warned_of():
    component = lines_of(STRAIGHT)
    assert "line 0 is stretched by 25 %" in component.warnings()["stretch"]
    assert lines_of({**STRAIGHT, "length": 4.9}).warnings() == {}


@pytest.mark.parametrize(("share", "is_told"), [(0.98, False), (1.02, True)])
def test_windows_longer_than_the_body_bears_are_warned_of(share, is_told):
    component = lines_of({**STRAIGHT, "length": 4.9})  # 2 √(m L/EA), of 1 kg
    component.take(motion())
    component.step(share * 2.0 * np.sqrt(4.9 / 8e3))
    assert ("window" in component.warnings()) == is_told


def test_a_fairlead_on_the_bed_may_be_below_it_by_rounding():
    component = lines_of({**CHAIN, "fairlead": [3.0, 0.0, 0.0]}, position=(3.0, 0.0, 0.0))
    load = load_of(component, position=(3.0, 0.0, -1e-12))["load.force"]
    assert load == pytest.approx(np.zeros((1, 3)), abs=1e-5)


def test_a_motion_that_is_not_finite_is_told():
    with pytest.raises(StepError, match=r"line 0, .*: the motion of body 0 is not finite"):
        load_of(lines_of(STRAIGHT), position=(np.nan, 0.0, 0.0))


def test_a_start_from_other_lines_is_refused():
    saved = lines_of(STRAIGHT).save()
    with pytest.raises(
        SceneError, match=r"must be of its 2 lines; found 1. Make both scenes alike"
    ):
        lines_of(STRAIGHT, STRAIGHT).begin_from(saved)
    with pytest.raises(SceneError, match="must be of its 2 bodies; found 1"):
        component = MooringLines(read(MooringLinesParams, {"lines": [STRAIGHT]}, "chains")[0])
        component.bind({"motion.mass": np.ones(2)}, frozenset({"motion", "load"}))
        component.begin_from(saved)
    with pytest.raises(SceneError, match=r"lines.0.fairlead must be that of the run .* 0.5 m away"):
        lines_of({**STRAIGHT, "fairlead": [3.5, 4.0, 0.0]}).begin_from(saved)


def test_a_restart_goes_on_with_the_same_bits_and_keeps_the_fairleads():
    whole, resumed = (lines_of(CHAIN, position=(3.0, 0.0, 2.0)) for _ in range(2))
    load_of(whole, position=(3.1, 0.1, 2.1))
    resumed.load(whole.save())
    begun = lines_of(CHAIN, position=(3.0, 0.0, 2.0))
    begun.begin_from(whole.save())
    begun.prime(motion(position=(3.1, 0.1, 2.1)))
    fields = [load_of(each, position=(3.2, 0.2, 2.2)) for each in (whole, resumed, begun)]
    for key in WANTED:
        assert np.array_equal(fields[0][key], fields[1][key])
        assert np.array_equal(fields[0][key], fields[2][key])


def test_a_picture_shows_a_chain_from_its_anchor_to_its_fairlead():
    component = lines_of(CHAIN, position=(3.0, 0.0, 2.0))
    view = component.view()
    assert view["points"][0] == pytest.approx([0.0, 0.0, 0.0])
    assert view["points"][-1] == pytest.approx([3.0, 0.0, 2.0])
    assert np.all(np.diff(view["tension"]) >= 0.0)
    assert np.all(view["points"][:, 2] >= 0.0)
