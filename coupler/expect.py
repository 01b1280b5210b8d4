"""What a scene must reproduce: one number each, from the recording, with its source.

The computed curve is ``scale * (recorded + offset)`` of one item of a recorded field. It is
measured, and the same measure is taken of the reference: a number, or a curve in a file.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal, NamedTuple

import numpy as np
from pydantic import Field as Limits

from quintet.coupler.record import Recording
from quintet.interfaces.component import Array, Field, Port
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import NotNegative, Number, parameters, unknown

Measure = Literal["rms", "crossing", "at", "max", "min", "mean"]
Index = Annotated[int, Limits(ge=0)]
ROUNDING = 1e-9  # of a time: what a run's last window may lack


class Curve(NamedTuple):
    """Values over time."""

    times: Array  # (m,) s
    values: Array  # (m,)


@parameters
class Expectation:
    """One number that a run must reproduce.

    ``rms`` is the distance to the curve of a file, over that curve's own times; ``crossing``
    the first time at which a level is passed; ``at`` the value at ``begin``; the others are
    taken between ``begin`` and ``end``. Impulse fields are measured as mean rates.
    """

    name: str
    component: str
    field: str  # "port.field"
    item: Index | Literal["mean", "max", "min"] = 0  # its number, or what to take of all
    axis: Index | None = None  # of a vector; None: its magnitude, or the field is scalar
    offset: Number = 0.0  # added to the recorded value
    scale: Number = 1.0  # then multiplied with it
    measure: Measure
    value: Number | None = None  # reference as a number
    csv: str | None = None  # reference as a curve: a file beside the scene
    begin: NotNegative = 0.0  # s
    end: NotNegative | None = None  # s; None: of the reference curve, or of the run
    level: Number | None = None  # of a crossing
    within: NotNegative  # tolerance, in `unit`; a crossing's in s
    unit: str
    source: str

    def __post_init__(self) -> None:
        wrong = [sentence for is_wrong, sentence in self._rules() if is_wrong]
        if wrong:
            raise ValueError(f"expectation {self.name}: " + " ".join(wrong))

    def _rules(self) -> list[tuple[bool, str]]:
        is_rms = self.measure == "rms"
        return [
            (is_rms and self.csv is None, "rms needs a reference curve; give csv."),
            (is_rms and self.value is not None, "rms compares with a curve; remove value."),
            (
                not is_rms and (self.value is None) == (self.csv is None),
                "it must have one reference; give either value or csv.",
            ),
            (
                (self.measure == "crossing") != (self.level is not None),
                "level belongs to a crossing, and a crossing needs one; "
                f"measure is {self.measure}, level is {self.level}.",
            ),
            (
                self.end is not None and self.measure == "at",
                "a value at one time has no end; give its time as begin, and remove end.",
            ),
            (
                self.end is not None and self.end <= self.begin and self.measure != "at",
                f"end must be later than begin; found {self.end} and {self.begin}.",
            ),
            (self.field.count(".") != 1, f"field must be port.field; found {self.field!r}."),
            (self.scale == 0.0, "scale must not be 0, as every run would do; remove it."),
        ]


@dataclass(frozen=True, slots=True)
class Outcome:
    """How a run compares with an expectation; ``value`` is None where it has none."""

    name: str
    value: float | None
    reference: float
    within: float
    unit: str
    met: bool
    source: str


def check(
    expectation: Expectation, gives: Mapping[str, tuple[Port, ...]], folder: Path
) -> list[str]:
    """Find every mistake that can be found before a run.

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
        fields = {f"{port.name}.{f.name}": f for port in ports for f in port.fields}
        mistakes += _check_field(expectation, fields)
    if expectation.csv is not None:
        try:
            reference_value(expectation, folder)
        except SceneError as error:
            mistakes += error.mistakes
    return mistakes


def _check_field(expectation: Expectation, fields: Mapping[str, Field]) -> list[str]:
    where = f"expectation {expectation.name}"
    if expectation.field not in fields:
        place = f"{where}: field {expectation.component}.{expectation.field}"
        return [unknown(place, expectation.field, fields)]
    shape, axis = fields[expectation.field].shape, expectation.axis
    if axis is not None and (len(shape) != 1 or axis >= shape[0]):
        allowed = f"0 to {shape[0] - 1}" if len(shape) == 1 else "left out"
        return [f"{where}: axis of {expectation.field} must be {allowed}; found {axis}."]
    return []


def curve(expectation: Expectation, recording: Recording) -> Curve:
    """Return the computed curve, offset and scaled; the rate of an impulse at mid-window."""
    ports = recording.ports(expectation.component)
    fields = {f"{port.name}.{f.name}": f for port in ports for f in port.fields}
    if mistakes := _check_field(expectation, fields):
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


def reference_curve(expectation: Expectation, folder: Path) -> Curve | None:
    """Read the reference curve: two columns, one header line, comments begin with #."""
    if expectation.csv is None:
        return None
    path = Path(folder) / expectation.csv
    where = f"expectation {expectation.name}: reference {expectation.csv}"
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise SceneError(
            f"{where} must be a text file beside the scene; {error}. Put it there."
        ) from error
    texts = [(n, line.partition("#")[0].strip()) for n, line in enumerate(lines, 1)]
    rows = [(n, text.split(",")) for n, text in texts if text]
    if rows and _numbers(rows[0][1]) is not None:
        raise SceneError(f"{where}: line {rows[0][0]} must be a header, as t_s,x_m. Add one.")
    return _curve(where, rows[1:])


def _curve(where: str, rows: list[tuple[int, list[str]]]) -> Curve:
    if len(rows) < 2:
        raise SceneError(f"{where} must have two lines of numbers or more; found {len(rows)}.")
    numbers: list[tuple[float, float]] = []
    for line, texts in rows:
        found = _numbers(texts)
        if found is None:
            raise SceneError(
                f"{where}: line {line} must be two finite numbers; found {','.join(texts)!r}. "
                "Correct it."
            )
        if numbers and found[0] <= numbers[-1][0]:
            raise SceneError(f"{where}: times must increase; line {line} has {found[0]:g}.")
        numbers.append(found)
    times, values = np.array(numbers).T
    return Curve(times, values)


def _numbers(texts: list[str]) -> tuple[float, float] | None:
    try:
        time, value = (float(text) for text in texts)
    except ValueError:
        return None
    return (time, value) if math.isfinite(time) and math.isfinite(value) else None


def _between(curve: Curve, begin: float, end: float) -> Curve:
    """Cut a curve to a window, ends interpolated; what reaches beyond the curve is left out."""
    times, values = curve
    begin, end = max(begin, times[0]), min(end, times[-1])
    inside = (times > begin) & (times < end)
    cut = np.concatenate([[begin], times[inside], [end]]) if end > begin else np.array([end])
    return Curve(cut, np.interp(cut, times, values))


def _crossing(curve: Curve, level: float) -> float:
    """First time at which a level is passed, or nan."""
    times, above = curve.times, curve.values - level
    passed = np.flatnonzero(above[:-1] * above[1:] <= 0.0)
    if not len(passed):
        return math.nan
    k = int(passed[0])
    if above[k] == above[k + 1]:  # both on the level
        return float(times[k])
    part = above[k] / (above[k] - above[k + 1])
    return float(times[k] + part * (times[k + 1] - times[k]))


def _measured(expectation: Expectation, curve: Curve, end: float) -> float:
    """Take the measure of a curve, all but rms."""
    if expectation.measure == "at":
        return float(np.interp(expectation.begin, curve.times, curve.values))
    part = _between(curve, expectation.begin, end)
    if expectation.measure == "crossing":
        assert expectation.level is not None
        return _crossing(part, expectation.level)
    if expectation.measure == "mean":
        span = part.times[-1] - part.times[0]
        return float(np.trapezoid(part.values, part.times) / span if span else part.values[0])
    return float(part.values.max() if expectation.measure == "max" else part.values.min())


def reference_value(expectation: Expectation, folder: Path) -> float:
    """Return what is expected: a number as given, or the same measure of the curve; 0 for rms."""
    reference = reference_curve(expectation, folder)
    if reference is None:
        return float(expectation.value or 0.0)
    where = f"expectation {expectation.name}: reference {expectation.csv}"
    end = math.inf if expectation.end is None else expectation.end
    first, last = reference.times[[0, -1]]
    if expectation.begin > last or end < first:
        raise SceneError(
            f"{where} must reach into {expectation.begin:g} to {end:g} s; it has {first:g} to "
            f"{last:g} s. Correct begin or end."
        )
    if expectation.measure == "rms":
        return 0.0
    value = _measured(expectation, reference, end)
    if math.isnan(value):
        raise SceneError(f"{where} must pass the level {expectation.level}; it does not.")
    return value


def evaluate(expectation: Expectation, recording: Recording, folder: Path) -> Outcome:
    """Compare a run with an expectation; one that ended too early does not meet it."""
    reference = reference_value(expectation, folder)
    value = _value(expectation, recording, folder)
    return Outcome(
        expectation.name,
        value if math.isfinite(value) else None,
        reference,
        expectation.within,
        expectation.unit,
        abs(value - reference) <= expectation.within,  # not so of nan
        expectation.source,
    )


def _value(expectation: Expectation, recording: Recording, folder: Path) -> float:
    if len(recording.times(expectation.component)) < 2:  # no window was finished
        return math.nan
    computed = curve(expectation, recording)
    last = float(recording.times(expectation.component)[-1])  # s
    wanted, target = expectation.end, reference_curve(expectation, folder)
    if expectation.measure == "at":
        wanted = expectation.begin
    elif wanted is None and target is not None and expectation.measure != "crossing":
        wanted = float(target.times[-1])
    end = last if wanted is None else wanted
    if max(end, expectation.begin) > last * (1.0 + ROUNDING):
        return math.nan
    if expectation.measure != "rms":
        return _measured(expectation, computed, end)
    assert target is not None
    inside = (target.times >= expectation.begin) & (target.times <= end)
    distance = np.interp(target.times, *computed)[inside] - target.values[inside]
    return float(np.sqrt(np.mean(distance**2))) if inside.any() else math.nan
