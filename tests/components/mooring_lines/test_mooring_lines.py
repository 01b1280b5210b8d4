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
    component.bind({"motion.mass": np.ones(bodies)}, frozenset({"motion"}))
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


def test_a_fairlead_below_the_bed_is_refused_and_ends_a_run():
    with pytest.raises(SceneError, match=r"lines.0: the fairlead must not be below the bed"):
        lines_of({**CHAIN, "fairlead": [3.0, 0.0, -0.5]})
    component = lines_of(CHAIN, position=(3.0, 0.0, 2.0))
    with pytest.raises(StepError, match=r"line 0, at 0.001 s: its fairlead is 0.2 m below the bed"):
        load_of(component, position=(3.0, 0.0, -0.2))
    free = lines_of({**CHAIN, "on_bed": False}, position=(3.0, 0.0, 2.0))
    assert load_of(free, position=(3.0, 0.0, -0.2))["line_gauge.lying"] == 0.0


def test_a_line_that_is_stretched_too_far_is_warned_of():
    component = lines_of(STRAIGHT)
    assert "line 0 is stretched by 25 %" in component.warnings()["stretch"]
    assert lines_of({**STRAIGHT, "length": 4.9}).warnings() == {}


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
