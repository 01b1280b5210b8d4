"""Expectations compared with a recording: what is measured, and of which reference.

The same measure is taken of the run's curve and of the reference.
"""

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from quintet.coupler.measures import time_series, wave_trains
from quintet.coupler.measures.expectation import (
    DISTANCES,
    MEASURED_IN,
    OF_WAVES,
    ROUNDING,
    Expectation,
)
from quintet.coupler.measures.harmonic import VALUES, amplitude
from quintet.coupler.measures.oscillation import fit
from quintet.coupler.measures.time_series import Curve
from quintet.interfaces.component import Field, Fields, Port, fields_of, lacked
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import shown, unknown
from quintet.interfaces.units import INTEGRATED, same

if TYPE_CHECKING:  # checking a scene reads no recording: h5py is not loaded for it
    from quintet.coupler.files.recording import Recording


@dataclass(frozen=True, slots=True)
class Outcome:
    """Comparison of a run with an expectation; ``value`` is None where the run has none.

    Where it has none because it ended before, ``not_reached`` is the time that it lacks, s.
    """

    name: str
    value: float | None
    reference: float
    within: float
    unit: str
    met: bool
    source: str
    required: bool = True
    not_reached: float | None = None
    reason: str = ""  # why a run that reached its times has no value
    reference_kind: str = ""
    read_from: str = ""
    doi: str = ""
    licence: str = ""
    scale: float | None = None  # what a relative error is relative to; None: nothing
    error_bar: float | None = None  # of the coupling, where the run estimates it


def check(
    expectation: Expectation, gives: Mapping[str, tuple[Port, ...]], folder: Path
) -> list[str]:
    """Check an expectation against the ports and reference data of a scene.

    `gives` has the ports that each component gives, by its name; `folder` is the scene's, where
    the reference curves are. Returns one sentence for each mistake; none when all is well.
    """
    where = f"expectation {expectation.name}"
    mistakes = []
    if expectation.component not in gives:
        place = f"{where}: component {expectation.component}"
        mistakes.append(unknown(place, expectation.component, gives))
    else:
        ports = gives[expectation.component]
        fields = fields_of(ports)
        mistakes += _check_field(expectation, fields, ports) or _check_unit(
            expectation, fields[expectation.field]
        )
    if expectation.csv is not None:
        try:
            reference_value(expectation, folder)
        except SceneError as error:
            mistakes += error.mistakes
    return mistakes


def _check_field(
    expectation: Expectation, fields: Mapping[str, Field], ports: tuple[Port, ...]
) -> list[str]:
    where = f"expectation {expectation.name}"
    if expectation.field not in fields:
        place = f"{where}: field {expectation.component}.{expectation.field}"
        if remedy := lacked(ports, expectation.field):
            return [f"{place} is not given with these settings. {remedy}"]
        return [unknown(place, expectation.field, fields)]
    shape, axis = fields[expectation.field].shape, expectation.axis
    if axis is not None and (len(shape) != 1 or axis >= shape[0]):
        allowed = f"0 to {shape[0] - 1}" if len(shape) == 1 else "left out"
        return [f"{where}: axis of {expectation.field} must be {allowed}; found {axis}."]
    if axis is None and shape and expectation.measure == "amplitude":
        return [
            f"{where}: an amplitude of {expectation.field} needs its axis, 0 to {shape[0] - 1}: "
            "magnitudes swing otherwise. Add axis."
        ]
    return []


def lacking_items(
    expectations: Iterable[Expectation], outputs: Mapping[str, Fields]
) -> Iterator[str]:
    """Say which items are expected that a component does not have.

    `outputs` has those of each component that are known, by its name.
    """
    for expectation in expectations:
        array = outputs.get(expectation.component, {}).get(expectation.field)
        if array is None:
            continue
        for item in (expectation.item, *(expectation.waves.items if expectation.waves else ())):
            if isinstance(item, int) and item >= len(array):
                yield (
                    f"expectation {expectation.name}: item must be below {len(array)}, as many as "
                    f"{expectation.component} has of {expectation.field}; found {item}. Correct it."
                )
                break


def _check_unit(expectation: Expectation, field: Field) -> list[str]:
    """Compare the unit with that of what is measured; a scale may make any of any."""
    unit = MEASURED_IN.get(expectation.measure, field.unit if expectation.scale == 1.0 else "")
    if expectation.measure == "integral" and unit:
        unit = INTEGRATED.get(unit, f"{unit} s")
    if not unit or same(unit, expectation.unit):
        return []
    remedy = f"Give value and within in {unit}"
    if expectation.measure not in MEASURED_IN:
        remedy += f", or the scale that makes {expectation.unit} of {unit}"
    quantity = expectation.field if expectation.measure not in MEASURED_IN else expectation.measure
    return [
        f"expectation {expectation.name}: unit must be {unit}, that of {quantity}; found "
        f"{shown(expectation.unit)}. {remedy}."
    ]


def curve(expectation: Expectation, recording: "Recording") -> Curve:
    """Return the computed curve as it is measured: averaged, and from its level on; one item's."""
    if expectation.waves is not None:
        expectation = replace(expectation, measure="mean", waves=None)
    return _prepared(expectation, whole_curve(expectation, recording))


def _prepared(expectation: Expectation, whole: Curve) -> Curve:
    if expectation.moving_mean and len(whole.times) > 1:
        whole = time_series.moving_mean(whole, expectation.moving_mean)
    return _since_level(whole, expectation.from_level)


def whole_curve(expectation: Expectation, recording: "Recording") -> Curve:
    """Return the recorded curve, offset and scaled; an impulse as its mean rate at mid-window.

    For measures of waves it has a column for each item of theirs.
    """
    if expectation.waves is not None:
        single = replace(expectation, measure="mean", waves=None)
        items = [replace(single, item=item) for item in expectation.waves.items]
        curves = [whole_curve(each, recording) for each in items]
        return Curve(curves[0].times, np.stack([curve.values for curve in curves], axis=1))
    ports = recording.ports(expectation.component)
    fields = fields_of(ports)
    if mistakes := _check_field(expectation, fields, ports):
        raise SceneError(mistakes)
    name, key, item = expectation.component, expectation.field, expectation.item
    times = recording.times(name)
    if isinstance(item, int):
        values = recording.history(name, key, item)[:, None]
    else:
        values = recording.field(name, key)
    if fields[key].centring == "impulse":
        spans = np.diff(times).reshape(-1, *[1] * (values.ndim - 1))
        values = values[1:] / spans
        times = (times[1:] + times[:-1]) / 2
    if expectation.axis is not None:
        values = values[..., expectation.axis]
    elif values.ndim > 2:
        values = np.linalg.norm(values.reshape(*values.shape[:2], -1), axis=2)
    values = values[:, 0] if isinstance(item, int) else getattr(values, item)(axis=1)
    return Curve(times, expectation.scale * (values + expectation.offset))


def _since_level(curve: Curve, level: float | None) -> Curve:
    """Count the times of a curve from where it first passes a level; nan if it never does."""
    if level is None:
        return curve
    return Curve(curve.times - time_series.crossing(curve, level), curve.values)


def reference_curve(expectation: Expectation, folder: Path) -> Curve | None:
    """Read the reference curve, if there is one."""
    if expectation.csv is None:
        return None
    where = f"expectation {expectation.name}: reference {expectation.csv}"
    whole = time_series.read(Path(folder) / expectation.csv, where, expectation.csv_second)
    whole = _since_level(whole, expectation.from_level)
    if math.isnan(whole.times[0]):
        raise SceneError(f"{where} must pass from_level {expectation.from_level}; it does not.")
    return whole


def _measured(expectation: Expectation, curve: Curve, end: float) -> float:
    """Evaluate a measure of one curve; distances need two."""
    if expectation.measure == "at":
        return float(np.interp(expectation.begin, curve.times, curve.values))
    part = time_series.between(curve, expectation.begin, end)
    if expectation.waves is not None:
        train = wave_trains.fit(part, expectation.waves)
        return dict(zip(OF_WAVES, (train.height, train.length, train.reflection), strict=True))[
            expectation.measure
        ]
    match expectation.measure:
        case "crossing":
            assert expectation.level is not None
            return time_series.crossing(part, expectation.level)
        case "period":
            return fit(part).period
        case "decay":
            return fit(part).decay
        case "amplitude":
            assert expectation.period is not None
            return amplitude(part, expectation.period)
        case "mean":
            return time_series.mean(part)
        case "integral":
            return time_series.integral(part)
        case "max":
            return float(part.values.max())
        case _:
            return float(part.values.min())


def reference_value(expectation: Expectation, folder: Path) -> float:
    """Return the reference: a number, or the measure of its curve; 0 for a distance."""
    reference = reference_curve(expectation, folder)
    if reference is None:
        return float(expectation.value or 0.0)
    where = f"expectation {expectation.name}: reference {expectation.csv}"
    end = math.inf if expectation.end is None else expectation.end
    if expectation.measure == "at":
        end = expectation.begin
    first, last = reference.times[[0, -1]]
    if expectation.begin > last or end < first:
        raise SceneError(
            f"{where} must reach into {expectation.begin:g} to {end:g} s; it has {first:g} to "
            f"{last:g} s. Correct begin or end."
        )
    if expectation.measure in DISTANCES:
        part = time_series.points_between(reference, expectation.begin, end)
        if not len(part.times):
            raise SceneError(
                f"{where} must have a time from {expectation.begin:g} to {end:g} s; it has none. "
                "Correct begin or end."
            )
        if expectation.measure == "relative_rms" and not part.values.any():
            raise SceneError(
                f"{where} must not be 0 at all times: relative_rms divides by its size. Use rms."
            )
        return 0.0
    value = _measured(expectation, reference, end)
    if math.isnan(value):
        rule = "oscillate" if expectation.level is None else f"pass the level {expectation.level}"
        raise SceneError(f"{where} must {rule}; it does not.")
    return value


def evaluate(expectation: Expectation, recording: "Recording", folder: Path) -> Outcome:
    """Compare a run with an expectation; a run that ended too early does not meet it."""
    return _outcome(expectation, *_value(expectation, recording, folder), folder)


def evaluate_curve(expectation: Expectation, recorded: Curve, folder: Path) -> Outcome:
    """Compare the output of another program with an expectation, as that of a run.

    Parameters
    ----------
    expectation : Expectation
    recorded : Curve
        Times (m,) s and values (m,) in the unit of the expectation's field, without its offset and
        scale.
    folder : Path
        Of the scene, where the reference curves are.
    """
    whole = Curve(recorded.times, expectation.scale * (recorded.values + expectation.offset))
    end = float(whole.times[-1])
    return _outcome(expectation, *value_of(expectation, whole, end, folder), folder)


def _outcome(
    expectation: Expectation, value: float, not_reached: float | None, folder: Path
) -> Outcome:
    """Outcome of a measured value, nan if there is none."""
    reference = reference_value(expectation, folder)
    return Outcome(
        expectation.name,
        value if math.isfinite(value) else None,
        reference,
        expectation.within,
        expectation.unit,
        abs(value - reference) <= expectation.within,  # not so of nan
        expectation.source,
        expectation.required,
        not_reached,
        "" if math.isfinite(value) or not_reached is not None else _why_none(expectation),
        expectation.reference_kind,
        expectation.read_from,
        expectation.doi,
        expectation.licence,
        error_scale(expectation, folder),
    )


def error_scale(expectation: Expectation, folder: Path) -> float | None:
    """What the error of an expectation is relative to; None where there is no such size."""
    if expectation.relative_to is not None:
        return expectation.relative_to
    if expectation.measure == "relative_rms":
        return 1.0
    if expectation.measure in DISTANCES:
        target = reference_curve(expectation, folder)
        assert target is not None
        end = float(target.times[-1]) if expectation.end is None else expectation.end
        part = time_series.between(target, expectation.begin, end)
        size = float(np.sqrt(np.mean(part.values**2)))
    else:
        size = abs(reference_value(expectation, folder))
    if size == 0.0 and same(expectation.unit, "1"):  # of a ratio the error is relative as it is
        return 1.0
    return size or None


def _why_none(expectation: Expectation) -> str:
    """Why a run that reached all times of an expectation has no value of it."""
    if expectation.from_level is not None:
        return f"the curve never passes from_level {expectation.from_level:g}, or has no value then"
    if expectation.level is not None:
        return f"the curve never passes the level {expectation.level:g}"
    if expectation.waves is not None:
        return (
            "the recorded curves hold no whole period, or the places cannot tell the two trains "
            "apart: two of them should be 0.05 to 0.45 lengths apart"
        )
    if expectation.period is not None:
        return (
            f"the recorded curve holds no whole period of {expectation.period:g} s, or fewer than "
            f"{VALUES} finite values in each"
        )
    return "the recorded curve has no finite value, or does not oscillate"


def _value(
    expectation: Expectation, recording: "Recording", folder: Path
) -> tuple[float, float | None]:
    """Measured value, nan if there is none, and the time [s] that the run did not reach."""
    times = recording.times(expectation.component)
    if len(times) < 2:  # no window was finished
        return math.nan, None
    return value_of(expectation, whole_curve(expectation, recording), float(times[-1]), folder)


def value_of(
    expectation: Expectation, whole: Curve, run_end: float, folder: Path
) -> tuple[float, float | None]:
    """Measure a curve of a run that ended at a time [s]; see `_value`."""
    computed, last = _prepared(expectation, whole), run_end
    if expectation.from_level is not None:
        last = float(computed.times[-1])
        if math.isnan(last):
            return math.nan, None
    wanted, target = expectation.end, reference_curve(expectation, folder)
    if expectation.measure == "at":
        wanted = expectation.begin
    elif wanted is None and target is not None and expectation.measure != "crossing":
        wanted = float(target.times[-1])
    end = last if wanted is None else wanted
    if (needed := max(end, expectation.begin)) > last * (1.0 + ROUNDING):
        return math.nan, needed + run_end - last
    if target is not None and expectation.measure in ("mean", "integral"):
        # Over the same time as of the reference, which may begin later or end before.
        computed = time_series.between(computed, *target.times[[0, -1]])
    if expectation.measure not in DISTANCES:
        return _measured(expectation, computed, end), None
    assert target is not None
    part = time_series.points_between(target, expectation.begin, end)
    return time_series.distance(computed, part, expectation.measure == "relative_rms"), None
