"""Error bars of a run: what its results and its expectations say of the coupling's error."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from quintet.coupler.coupling.judgement.error_bar import ErrorBar
from quintet.coupler.coupling.judgement.error_growth import DIFFERENCES
from quintet.coupler.files.recording import Recording
from quintet.coupler.measures.error_bars import (
    CONFIDENCE,
    Samples,
    bar_about,
    error_at_end,
    error_curve,
    window_bar,
)
from quintet.coupler.measures.evaluation import value_of, whole_curve
from quintet.coupler.measures.expectation import Expectation
from quintet.coupler.measures.time_series import Curve
from quintet.coupler.measures.watched import Watched, of_expectation, of_path
from quintet.coupler.scene.scene import Scene
from quintet.interfaces.component import Array, fields_of


def watched(scene: Scene) -> list[Watched]:
    """Quantities that a scene watches: those of its expectations first."""
    gives = {name: fields_of(plan.gives) for name, plan in scene.components.items()}
    paths = [path.partition(".") for path in scene.file.output.watch]
    return [
        *(of_expectation(each, gives[each.component][each.field]) for each in scene.expect),
        *(of_path(f"{name}.{key}", gives[name][key]) for name, _, key in paths),
    ]


def error_bar_of(scene: Scene) -> ErrorBar:
    """Return what samples the windows of a run."""
    needs = {
        name: {
            key
            for key, field in fields_of(plan.gives).items()
            if field.centring == "instant" and field.kind == "value"
        }
        for name, plan in scene.components.items()
    }
    return ErrorBar(watched(scene), scene.file.error_bar.every, needs)


def summary(bar: ErrorBar, scene: Scene, recording: Recording) -> dict[str, Any]:
    """Return what ``results.json`` has of a run's error bars."""
    rows = [
        _row(number, quantity, bar, scene, recording)
        for number, quantity in enumerate(watched(scene))
    ]
    return {
        "confidence": CONFIDENCE,
        "every": bar.every,
        "windows": [sample.window for sample in bar.samples],
        "skipped": bar.skipped,
        "weights": [sample.weights for sample in bar.samples],
        "watched": rows,
    }


def _row(
    number: int, quantity: Watched, bar: ErrorBar, scene: Scene, recording: Recording
) -> dict[str, Any]:
    """Bars of one quantity, in its unit, and the samples from which they are."""
    columns = {
        key: [getattr(sample, key)[number] for sample in bar.samples]
        for key in ("errors", "rests", "drifts")
    }
    expectation = {each.name: each for each in scene.expect}.get(quantity.name)
    value = None
    if any(sample.window > 1 for sample in bar.samples):
        samples = Samples(
            [sample.window for sample in bar.samples],
            [sample.weights for sample in bar.samples],
            columns["rests"],
            columns["drifts"],
        )
        value = (
            _of_field(quantity, bar.every, samples, recording)
            if expectation is None
            else _of_value(expectation, bar.every, samples, scene, recording)
        )
    # The first window is not like the others.
    usual = [e for e, s in zip(columns["errors"], bar.samples, strict=True) if s.window > 1]
    key = quantity.component, quantity.field
    return {
        "name": quantity.name,
        "component": quantity.component,
        "field": quantity.field,
        "order": bar.orders.order(key) if key in bar.orders.products else None,
        "window": number_or_none(window_bar(usual)),
        "value": value,
        **columns,
    }


def number_or_none(value: float) -> float | None:
    """Return a number that JSON has."""
    return value if math.isfinite(value) else None


def _of_field(
    quantity: Watched, every: int, samples: Samples, recording: Recording
) -> float | None:
    """Bar of a whole field at the run's end: root mean square over its numbers."""
    name, key = quantity.component, quantity.field
    times = recording.times(name)
    rows = slice(max(len(times) - DIFFERENCES - 1, int(quantity.is_impulse)), None)
    fields = recording.field(name, key, rows)
    if quantity.is_impulse:
        spans = np.diff(times)[-len(fields) :]  # s
        fields = fields / spans.reshape(-1, *[1] * (fields.ndim - 1))
    values = fields.reshape(len(fields), -1)
    return number_or_none(bar_about(*error_at_end(samples, every, len(times) - 1, values)))


def _of_value(
    expectation: Expectation, every: int, samples: Samples, scene: Scene, recording: Recording
) -> float | None:
    """Bar of the value of an expectation: what it changes by as its curve is corrected."""
    if expectation.waves is not None:  # of several curves; their errors are not estimated
        return None
    whole = whole_curve(expectation, recording)
    times = recording.times(expectation.component)
    end, first = float(times[-1]), len(times) - len(whole.times)
    errors = error_curve(samples, every, whole, first)
    expected, deviation = errors.expected, errors.deviation

    def corrected(error: Array) -> float:
        shifted = Curve(whole.times, whole.values - error)
        return value_of(expectation, shifted, end, scene.folder)[0]

    value = corrected(np.zeros(1))
    middle, *sides = (
        value - corrected(error) for error in (expected, expected - deviation, expected + deviation)
    )
    # nan, where one of the curves has no value: its scatter is not known.
    return number_or_none(bar_about(middle, float(np.max(np.abs(np.array(sides) - middle)))))


def beside(outcomes: Sequence[Any], rows: Sequence[Mapping[str, Any]]) -> list[Any]:
    """Return outcomes of expectations, each with the error bar of its value."""
    bars = {row["name"]: row["value"] for row in rows}
    return [replace(outcome, error_bar=bars.get(outcome.name)) for outcome in outcomes]
