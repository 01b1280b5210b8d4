"""Expectations: numbers that a scene must reproduce, from its recording, each with a source.

The computed curve is ``scale * (recorded + offset)`` of one item of a recorded field. It is
measured, and the same measure is taken of the reference: a number, or a curve in a file.
"""

from typing import Annotated, Literal

import pydantic

from quintet.coupler.measures.provenance import ReadFrom, ReferenceKind, provenance_rules
from quintet.coupler.measures.wave_trains import WaveLine
from quintet.interfaces.params import NotNegative, Number, Positive, parameters

Measure = Literal[
    "rms", "relative_rms", "crossing", "at", "max", "min", "mean", "integral", "period", "decay",
    "amplitude", "wave_height", "wave_length", "reflection",
]  # fmt: skip
DISTANCES = ("rms", "relative_rms")  # to a curve
OF_WAVES = ("wave_height", "wave_length", "reflection")  # that run along a line
Index = Annotated[int, pydantic.Field(ge=0)]
MEASURED_IN = {"crossing": "s", "period": "s", "decay": "1/s", "relative_rms": "1"} | {
    "wave_length": "m",
    "reflection": "1",
}
ROUNDING = 1e-9  # of a time: what a run's last window may lack


@parameters
class Expectation:
    """One number that a run must reproduce.

    ``rms`` is the distance to the curve of a file, over that curve's own times, and
    ``relative_rms`` the same over the curve's own size; ``crossing`` the first time at which a
    level is passed; ``at`` the value at ``begin``; ``period`` [s] and ``decay`` [1/s] those of the
    damped oscillation that fits best; ``amplitude`` that of the harmonic of a known ``period``;
    ``integral`` is over time; ``wave_height``, ``wave_length`` [m] and ``reflection`` are those of
    waves along a line of items, ``waves``; these and the others are taken between ``begin`` and
    ``end``. Impulse fields are measured as mean rates.

    Parameters
    ----------
    name
        Of the expectation.
    component
        That gives the field.
    field
        ``"port.field"``.
    item : 1
        Its number, from 0, or what is taken of all items.
    axis : 1
        Number of a vector's component, from 0; its magnitude if not given.
    offset : of the field
        Added to the recorded value.
    scale : `unit` over that of the field
        What the sum is then multiplied with.
    measure
        Distance to the reference curve (rms), also over that curve's own size (relative_rms); time
        at which `level` is passed first (crossing); value at the time `begin` (at); largest,
        smallest and mean value; integral over time; period and decay of the damped oscillation
        that fits best; amplitude of the harmonic of a known `period`, without drift; height, length
        and coefficient of reflection of waves.
    period : s
        Of the harmonic whose amplitude is measured, as of the waves that a body floats in.
    waves
        Items along the way of waves; pictures show the curve of `item`.
    value : `unit`
        The reference as a number; this or `csv`.
    csv
        The reference as a curve: a file beside the scene, with columns of time and value.
    csv_second : s
        One unit of the times in that file.
    begin : s
        Of the part that is measured.
    end : s
        Of the part that is measured; that of the reference curve, or of the run, if not given.
    level : `unit`, after offset and scale
        That a crossing passes.
    moving_mean : s
        The run's curve is first averaged over so long, as a reference may have been.
    from_level : `unit`, after offset and scale
        Times count from where the curve first passes it, as after the arrival of a wave: in the
        run, and in the reference.
    within : `unit`
        Tolerance; of a crossing in s.
    relative_to : `unit`
        What a relative error is relative to; if not given, the reference, the size of the curve
        (rms), or 1 (of a ratio whose reference is 0, and of relative_rms).
    deviation : `unit`
        Standard deviation of the reference, where an experiment was repeated; an ensemble compares
        its own with it.
    unit
        Of the measured value.
    source
        Where the reference is from.
    reference_kind
        What the reference is: a formula, a law of conservation, or equations solved to rounding
        (exact), an experiment, another program or method (other code), or a finer or differently
        arranged run of quintet itself (own finest run).
    read_from
        How the reference was obtained: from a formula, a conservation law, the text of a
        publication, a table, a digitised figure, a data file, or a run of a program. An experiment
        and another code need it.
    doi
        DOI of the publication, without an address before it; ``"none"`` if it has none. Experiments
        need it, and other codes that were not run for this scene.
    licence
        Licence of reference data that are not ours, or that none is stated. Curves of experiments
        and of other codes need it.
    quantity
        What the curve is, in words, for pictures; told by its field if not given.
    required
        Whether a run must meet it; one that is not required is told beside the others.
    """

    name: str
    component: str
    field: str
    item: Index | Literal["mean", "max", "min"] = 0
    axis: Index | None = None
    offset: Number = 0.0
    scale: Number = 1.0
    measure: Measure
    period: Positive | None = None
    waves: WaveLine | None = None
    value: Number | None = None
    csv: str | None = None
    csv_second: Positive = 1.0
    begin: NotNegative = 0.0
    end: NotNegative | None = None
    level: Number | None = None
    moving_mean: NotNegative = 0.0
    from_level: Number | None = None
    within: NotNegative
    relative_to: Positive | None = None
    deviation: Positive | None = None
    unit: str
    source: str
    reference_kind: ReferenceKind = ""
    read_from: ReadFrom = ""
    doi: str = ""
    licence: str = ""
    quantity: str = ""
    required: bool = True

    def __post_init__(self) -> None:
        wrong = [sentence for is_wrong, sentence in self._rules() if is_wrong]
        if wrong:
            raise ValueError(f"expectation {self.name}: " + " ".join(wrong))

    def _rules(self) -> list[tuple[bool, str]]:
        is_rms = self.measure in DISTANCES
        return [
            (is_rms and self.csv is None, f"{self.measure} needs a reference curve; give csv."),
            (
                is_rms and self.value is not None,
                f"{self.measure} compares with a curve; remove value.",
            ),
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
            (
                self.from_level is not None and self.measure in ("crossing", "at"),
                "times of a crossing, and of a value, count from the start; remove from_level.",
            ),
            (
                (self.measure == "amplitude") != (self.period is not None),
                "period belongs to an amplitude, which needs one; "
                f"measure is {self.measure}, period is {self.period}.",
            ),
            (
                self.measure == "amplitude" and bool(self.moving_mean),
                "moving_mean lowers an amplitude; remove it.",
            ),
            (
                (self.measure in OF_WAVES) != (self.waves is not None),
                "waves belongs to wave_height, wave_length and reflection, which need it; "
                f"measure is {self.measure}.",
            ),
            (
                self.waves is not None
                and bool(self.csv or self.from_level is not None or self.moving_mean),
                "waves are compared with a number; remove csv, from_level and moving_mean.",
            ),
            (self.field.count(".") != 1, f"field must be port.field; found {self.field!r}."),
            (self.scale == 0.0, "scale must not be 0, as every run would do; remove it."),
            *provenance_rules(
                self.reference_kind, self.read_from, self.doi, self.licence, self.csv
            ),
        ]
