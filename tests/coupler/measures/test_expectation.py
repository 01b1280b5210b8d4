"""An expectation takes the measure it names, and reports each mistake in a sentence."""

from dataclasses import asdict

import numpy as np
import pytest

from quintet.coupler.files.recording import Instant, Recorder, Recording
from quintet.coupler.measures.evaluation import check, curve, evaluate, reference_curve
from quintet.coupler.measures.expectation import Expectation
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import read
from quintet.interfaces.ports import LOAD, MOTION

END, WINDOWS = 2.0, 200


@pytest.fixture
def recording(tmp_path):
    """One body: x = 1 + t, z = sin t, and an impulse of (3, 0, 4) N s per second."""
    with Recorder(tmp_path / "recording.h5", "", "") as recorder:
        recorder.component("cubes", (MOTION, LOAD), {})
        for k in range(WINDOWS + 1):
            t = k * END / WINDOWS
            row = {"motion.position": np.array([[0.0, 0.0, 0.0], [1.0 + t, 0.0, np.sin(t)]])}
            row["load.force"] = np.full((2, 1), min(k, 1) * END / WINDOWS) * [[3.0, 0.0, 4.0]]
            recorder.add("cubes", Instant(t, k), row)
    with Recording(tmp_path / "recording.h5") as reader:
        yield reader


def _expectation(**settings):
    base = {
        "name": "top.x", "component": "cubes", "field": "motion.position", "item": 1, "axis": 0,
        "within": 1e-9, "unit": "m", "source": "by hand",
    }  # fmt: skip
    return Expectation(**(base | settings))


def _write(folder, text):
    (folder / "ref.csv").write_text(text)


@pytest.mark.parametrize(
    ("settings", "value"),
    [
        ({"measure": "at", "begin": 0.505}, 1.505),
        ({"measure": "max", "begin": 0.25, "end": 0.755}, 1.755),
        ({"measure": "min", "begin": 0.255, "end": 0.75}, 1.255),
        ({"measure": "mean", "begin": 0.255, "end": 0.755}, 1.505),
        ({"measure": "mean"}, 2.0),
        ({"measure": "max", "moving_mean": 0.5, "begin": 0.5, "end": 1.5}, 2.5),
        ({"measure": "integral", "begin": 0.25, "end": 0.75}, 0.75),
        ({"measure": "mean", "from_level": 1.5, "begin": 0.1, "end": 0.2}, 1.65),
        ({"measure": "crossing", "level": 1.503, "unit": "s"}, 0.503),
        ({"measure": "at", "begin": 1.0, "offset": -3.0, "scale": 2.0}, -2.0),
    ],
)
def test_each_measure_of_a_straight_line_is_exact(tmp_path, recording, settings, value):
    outcome = evaluate(_expectation(value=value, **settings), recording, tmp_path)
    assert outcome.met and outcome.value == pytest.approx(value, abs=1e-12)
    shifted = evaluate(_expectation(value=value + 1e-3, **settings), recording, tmp_path)
    assert not shifted.met and shifted.reference == value + 1e-3


def test_rms_is_taken_over_the_times_of_the_reference(tmp_path, recording):
    _write(tmp_path, "# a source\nt_s,x_m\n0.1,1.1\n0.5,1.8\n0.9,1.5  # off\n1.7,9\n")
    expectation = _expectation(measure="rms", csv="ref.csv", end=1.0, within=0.5)
    outcome = evaluate(expectation, recording, tmp_path)
    assert outcome.value == pytest.approx(np.sqrt((0.3**2 + 0.4**2) / 3))
    assert outcome.met and outcome.reference == 0.0


def test_a_reference_curve_is_measured_as_the_computed_one(tmp_path, recording):
    _write(tmp_path, "t,x\n0,1\n4,3\n")
    crossing = _expectation(
        measure="crossing", level=1.5, csv="ref.csv", within=0.5, end=1.8, unit="s"
    )
    outcome = evaluate(crossing, recording, tmp_path)
    assert (outcome.value, outcome.reference) == (pytest.approx(0.5), pytest.approx(1.0))
    assert outcome.met
    top = evaluate(_expectation(measure="max", csv="ref.csv", end=2.0), recording, tmp_path)
    assert (top.value, top.reference, top.met) == (pytest.approx(3.0), 2.0, False)


def test_times_count_from_a_level_in_the_run_and_in_the_reference(tmp_path, recording):
    """x = 1 + t passes 1.5 at 0.5 s, the reference at 2 s; both rise by 1 a second after it."""
    _write(tmp_path, "t,x\n1.0,0.5\n2.0,1.5\n4.0,3.5\n")
    settings = {"from_level": 1.5, "begin": 0.0, "end": 1.0, "csv": "ref.csv"}
    integral = evaluate(
        _expectation(measure="integral", unit="m s", **settings), recording, tmp_path
    )
    assert integral.met and integral.value == pytest.approx(2.0)
    assert evaluate(_expectation(measure="rms", **settings), recording, tmp_path).met
    unreached_level = _expectation(measure="mean", value=1.0, from_level=9.0)
    assert evaluate(unreached_level, recording, tmp_path).value is None
    late_end = _expectation(measure="mean", value=1.0, from_level=1.5, end=1.6)
    outcome = evaluate(late_end, recording, tmp_path)
    assert outcome.value is None  # the run ends 1.5 s after
    assert outcome.not_reached == pytest.approx(0.5 + 1.6), "a time of the run, not since the level"
    with pytest.raises(SceneError, match=r"must pass from_level 9.0; it does not"):
        evaluate(_expectation(measure="mean", csv="ref.csv", from_level=9.0), recording, tmp_path)


def test_an_oscillation_is_measured_by_its_period_and_decay(tmp_path, recording):
    # A third of a cycle of z = sin t is too little, and y = 0 does not oscillate.
    base = {"measure": "period", "unit": "s", "value": 2.0 * np.pi}
    assert evaluate(_expectation(axis=2, **base), recording, tmp_path).value is None
    assert evaluate(_expectation(axis=1, **base), recording, tmp_path).value is None
    _write(tmp_path, "t,x\n" + "\n".join(f"{0.01 * k},{np.sin(k)}" for k in range(100)))
    expectation = _expectation(
        measure="period", csv="ref.csv", csv_second=100.0, unit="s", within=1.0
    )
    assert evaluate(expectation, recording, tmp_path).reference == pytest.approx(2.0 * np.pi)


def test_times_of_a_reference_may_have_a_unit_of_their_own(tmp_path, recording):
    _write(tmp_path, "T,X\n0,1\n4,3\n")
    expectation = _expectation(measure="rms", csv="ref.csv", csv_second=0.5, within=1e-9)
    assert evaluate(expectation, recording, tmp_path).met
    relative = _expectation(measure="relative_rms", csv="ref.csv", csv_second=0.25, end=1.0)
    assert evaluate(relative, recording, tmp_path).value == pytest.approx(np.sqrt(1.0 / 10.0))


def test_a_vector_without_axis_is_its_magnitude_and_an_impulse_its_mean_rate(tmp_path, recording):
    expectation = _expectation(field="load.force", axis=None, measure="mean", value=5.0, unit="N")
    assert evaluate(expectation, recording, tmp_path).met
    computed = curve(expectation, recording)
    assert len(computed.times) == WINDOWS and computed.times[0] == pytest.approx(END / WINDOWS / 2)


@pytest.mark.parametrize(
    ("item", "axis", "value"),
    [
        ("max", 0, 1.5), ("min", 0, 0.0), ("mean", 0, 0.75),
        ("mean", None, 0.5 * np.hypot(1.5, np.sin(0.5))),
    ],
)  # fmt: skip
def test_all_items_come_to_one_number(tmp_path, recording, item, axis, value):
    expectation = _expectation(
        item=item, axis=axis, measure="at", begin=0.5, value=value, within=1e-12
    )
    assert evaluate(expectation, recording, tmp_path).met
    push = {"field": "load.force", "axis": None, "measure": "mean", "value": 5.0, "unit": "N"}
    assert evaluate(_expectation(item=item, **push), recording, tmp_path).met


@pytest.mark.parametrize(
    "settings",
    [
        {"measure": "at", "begin": 2.1, "value": 3.1},
        {"measure": "max", "end": 2.1, "value": 3.0},
        {"measure": "rms", "csv": "ref.csv"},
        {"measure": "crossing", "level": 1.5, "value": 0.5, "end": 3.0},
        {"measure": "crossing", "level": 7.0, "value": 0.5},
    ],
)
def test_a_run_that_ends_too_early_has_no_value_and_does_not_meet(tmp_path, recording, settings):
    _write(tmp_path, "t,x\n0,1\n2.5,3.5\n")
    outcome = evaluate(_expectation(**settings), recording, tmp_path)
    assert asdict(outcome)["value"] is None and not outcome.met
    if settings.get("level") == 7.0:  # its time is any
        assert outcome.not_reached is None, "a level may be missed before the run ends"
    else:
        assert outcome.not_reached > 2.0, "the time that was needed lies beyond the run's 2 s"


def test_a_level_that_is_never_passed_is_told(tmp_path, recording):
    outcome = evaluate(
        _expectation(measure="crossing", level=7.0, value=0.5, unit="s"), recording, tmp_path
    )
    assert outcome.value is None and not outcome.met
    assert outcome.reason == "the curve never passes the level 7"


@pytest.mark.parametrize("rows", [0, 1])
def test_a_run_that_finished_no_window_meets_nothing(tmp_path, rows):
    with Recorder(tmp_path / "recording.h5", "", "") as recorder:
        recorder.component("cubes", (MOTION,), {})
        for _ in range(rows):
            recorder.add("cubes", Instant(0.0, 0), {"motion.position": np.zeros((2, 3))})
    with Recording(tmp_path) as reader:
        outcome = evaluate(_expectation(measure="max", value=0.0), reader, tmp_path)
    assert outcome.value is None and not outcome.met


def test_a_last_window_that_is_rounded_still_reaches_the_end(tmp_path, recording):
    expectation = _expectation(measure="max", end=2.0 * (1 + 1e-12), value=3.0)
    assert evaluate(expectation, recording, tmp_path).met


@pytest.mark.parametrize(
    ("settings", "word"),
    [
        ({"measure": "rms", "value": 1.0}, "rms needs a reference curve; give csv"),
        ({"measure": "relative_rms"}, "relative_rms needs a reference curve; give csv"),
        ({"measure": "at"}, "give either value or csv"),
        ({"measure": "max", "value": 1.0, "csv": "a.csv"}, "give either value or csv"),
        ({"measure": "crossing", "value": 1.0}, "a crossing needs one"),
        ({"measure": "max", "value": 1.0, "level": 2.0}, "level belongs to a crossing"),
        ({"measure": "max", "value": 1.0, "begin": 2.0, "end": 1.0}, "end must be later"),
        ({"measure": "at", "value": 1.0, "end": 1.0}, "one time has no end"),
        ({"measure": "max", "value": 1.0, "field": "position"}, "must be port.field"),
        ({"measure": "max", "value": 1.0, "scale": 0.0}, "scale must not be 0"),
        ({"measure": "max", "value": 1.0, "widthin": 1.0}, "Did you mean within?"),
        ({"measure": "median", "value": 1.0}, "measure should be 'rms'"),
        ({"measure": "max", "value": 1.0, "item": -1}, "item should be greater"),
        ({"measure": "max", "value": "high"}, "value should be a valid number"),
    ],
)
def test_a_wrong_expectation_is_refused_with_a_sentence(settings, word):
    keys = {
        "name": "top.x", "component": "cubes", "field": "motion.position", "within": 0.1,
        "unit": "m", "source": "by hand",
    }  # fmt: skip
    expectation, mistakes = read(Expectation, keys | settings, "expect[0]")
    assert expectation is None
    assert any(word in mistake for mistake in mistakes), mistakes


@pytest.mark.parametrize(
    ("settings", "word"),
    [
        ({"component": "cube"}, "Did you mean cubes?"),
        ({"field": "motion.postion"}, "Did you mean motion.position?"),
        ({"axis": 3}, "axis of motion.position must be 0 to 2; found 3"),
        ({"csv": "nowhere.csv", "value": None}, "must be a text file beside the scene"),
    ],
)
def test_mistakes_against_the_ports_are_found_before_a_run(tmp_path, settings, word):
    expectation = _expectation(**({"measure": "max", "value": 1.0} | settings))
    mistakes = check(expectation, {"cubes": (MOTION, LOAD)}, tmp_path)
    assert len(mistakes) == 1 and word in mistakes[0]


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("1,2\n3,4\n", "line 1 must be a header"),
        ("t,x\n1,2\n", "two lines of numbers or more; found 1"),
        ("t,x\n1,2\n2,b\n", "line 3 must be two finite numbers"),
        ("t,x\n1,2,3\n2,3,4\n", "line 2 must be two finite numbers"),
        ("t,x\n1,2\n2,nan\n", "line 3 must be two finite numbers"),
        ("# note\nt,x\n2,2\n1,2\n", "times must increase; line 4"),
    ],
)
def test_a_wrong_reference_file_is_refused_by_its_line(tmp_path, text, word):
    _write(tmp_path, text)
    with pytest.raises(SceneError, match=word):
        reference_curve(_expectation(measure="rms", csv="ref.csv"), tmp_path)


def test_a_reference_that_cannot_be_measured_is_a_mistake(tmp_path):
    _write(tmp_path, "t,x\n0,1\n1,2\n")
    gives = {"cubes": (MOTION, LOAD)}
    for settings, word in (
        ({"measure": "crossing", "level": 5.0, "unit": "s"}, "must pass the level 5.0"),
        ({"measure": "rms", "begin": 3.0}, "must reach into 3 to inf s; it has 0 to 1 s"),
        ({"measure": "rms", "begin": 0.2, "end": 0.8}, "must have a time from 0.2 to 0.8 s"),
    ):
        mistakes = check(_expectation(csv="ref.csv", **settings), gives, tmp_path)
        assert len(mistakes) == 1 and word in mistakes[0]


FOREIGN = {"reference_kind": "experiment", "read_from": "table", "doi": "10.1098/rsta.1952.0006"}
PROVENANCE = {
    "no reading": ({"read_from": ""}, "experiment needs read_from. Say how its numbers were read."),
    "no doi": ({"doi": ""}, "experiment needs doi. Give that of its publication, or 'none'"),
    "another doi": ({"doi": "doi.org/10.1/x"}, "doi must begin with 10."),
    "address": ({"doi": "https://doi.org/10.1098/rsta.1952.0006"}, "without an address before it"),
    "a law": ({"read_from": "conservation law"}, "an experiment is not read from a conservation"),
    "curve": (
        {"measure": "rms", "value": None, "csv": "ref.csv"},
        "a curve of kind experiment needs licence.",
    ),
    "other code": (
        {"reference_kind": "other code", "read_from": "table", "doi": ""},
        "a reference of kind other code needs doi.",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", PROVENANCE)
def test_what_others_found_needs_its_provenance(case):
    settings, sentence = PROVENANCE[case]
    with pytest.raises(ValueError, match=r"expectation top\.x") as error_info:
        _expectation(**{"measure": "at", "value": 1.0, **FOREIGN, **settings})
    assert sentence in str(error_info.value)


def test_provenance_that_is_complete_is_taken_and_told(tmp_path, recording):
    for settings in (
        FOREIGN,
        {**FOREIGN, "doi": "none"},
        {"reference_kind": "other code", "read_from": "run"},
        {"reference_kind": "exact"},
    ):
        expectation = _expectation(measure="at", value=1.0, **settings)
        outcome = evaluate(expectation, recording, tmp_path)
        assert outcome.doi == settings.get("doi", "")
        assert outcome.read_from == settings.get("read_from", "")


def test_a_value_before_its_reference_begins_is_a_mistake(tmp_path):
    _write(tmp_path, "t,x\n1,1\n2,2\n")
    expectation = _expectation(csv="ref.csv", measure="at", begin=0.5)
    (mistake,) = check(expectation, {"cubes": (MOTION, LOAD)}, tmp_path)
    assert "must reach into 0.5 to 0.5 s; it has 1 to 2 s" in mistake


def test_a_curve_of_zeros_has_no_relative_distance(tmp_path):
    _write(tmp_path, "t,x\n0,0\n1,0\n2,3\n")
    expectation = _expectation(csv="ref.csv", measure="relative_rms", unit="1", end=1.0)
    (mistake,) = check(expectation, {"cubes": (MOTION, LOAD)}, tmp_path)
    assert "must not be 0 at all times" in mistake


@pytest.mark.parametrize(("measure", "unit"), [("mean", "m"), ("integral", "m s")])
def test_a_mean_is_over_the_times_of_its_reference(tmp_path, recording, measure, unit):
    """x = 1 + t from 0 to 2 s; the reference is the same curve, from 1 to 1.5 s."""
    _write(tmp_path, "t,x\n1,2\n1.5,2.5\n")
    for end in (None, 2.0):
        expectation = _expectation(csv="ref.csv", measure=measure, unit=unit, end=end)
        assert evaluate(expectation, recording, tmp_path).met
