"""Time series of a run against what is expected of them: reference curves and single values.

Matplotlib is loaded by the functions that draw: a run without pictures does not need it.
"""

import math
import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from quintet.coupler.files.recording import Recording
from quintet.coupler.measures.expectation import (
    DISTANCES,
    Expectation,
    Outcome,
    curve,
    reference_curve,
)
from quintet.coupler.measures.oscillation import fit
from quintet.coupler.measures.time_series import Curve, between, mean
from quintet.coupler.report.panels import curve_panels, save
from quintet.interfaces.component import Field, fields_of

IN_UNIT = ("rms", "at", "max", "min", "mean")  # measures that have the unit of their curve
PANELS = 12  # at most
COMPUTED, BAND = "tab:blue", "tab:orange"
MARKS = (("o", "black"), ("s", "tab:red"), ("^", "tab:green"), ("D", "tab:purple"))
AXES = "xyz"
FINE = 1000  # points of a curve that is drawn by its formula
LINE = 44  # characters of a line beside a panel or in its legend
LINES = 2  # of a source in a legend
Outcomes = Mapping[str, Outcome]


def comparison(
    folder: Path,
    expectations: Sequence[Expectation],
    outcomes: Sequence[Outcome],
    recording: Recording,
    out: Path,
    title: str = "",
    values: bool = False,
) -> Path | None:
    """Draw computed curves against their references, one panel for each curve.

    Parameters
    ----------
    folder : Path
        Of the scene, where the reference curves are.
    expectations, outcomes : sequences
        Matched by name.
    recording : Recording
    out : Path
        The picture; its ending chooses the format.
    title : str
        Above all panels.
    values : bool
        Whether curves are drawn too whose only references are single values.

    Returns
    -------
    Path or None
        `out`, or None where there is nothing to be drawn.
    """
    curves: dict[tuple[Any, ...], list[Expectation]] = {}
    for one in expectations:
        if one.csv is not None or values:
            curves.setdefault(_curve_of(one), []).append(one)
    wanted = sorted(curves.values(), key=lambda ones: all(one.csv is None for one in ones))
    if not wanted:
        return None
    if len(wanted) > PANELS:
        title = f"{title}\nthe first {PANELS} of {len(wanted)} curves"
        wanted = wanted[:PANELS]
    results = {outcome.name: outcome for outcome in outcomes}
    figure, panels = curve_panels(len(wanted), title.strip())
    for panel, ones in zip(panels, wanted, strict=True):
        _draw(panel, ones, results, recording, Path(folder))
    return save(figure, out)


def _curve_of(one: Expectation) -> tuple[Any, ...]:
    """What makes a computed curve: expectations that agree in it share a panel."""
    return (
        one.component, one.field, one.item, one.axis, one.offset, one.scale, one.moving_mean,
        one.from_level,
    )  # fmt: skip


def _draw(
    panel: Any, ones: list[Expectation], results: Outcomes, recording: Recording, folder: Path
) -> None:
    computed = curve(ones[0], recording)
    panel.plot(*computed, color=COMPUTED, linewidth=1.5, label="computed")
    _draw_oscillation(panel, ones, computed)
    drawn: list[str] = []
    last = max(_end(one, computed, folder) for one in ones)
    for one in ones:
        reference = reference_curve(one, folder)
        mark, colour = MARKS[len(drawn) % len(MARKS)]
        if reference is None:
            _draw_value(panel, one, computed)
        elif one.csv not in drawn:
            drawn.append(str(one.csv))
            seen = reference.times <= last
            panel.plot(
                reference.times[seen], reference.values[seen], mark, color=colour, markersize=3.5,
                fillstyle="none", label=shortened(one.source),
            )  # fmt: skip
        if one.level is not None:
            panel.axhline(one.level, color="grey", linewidth=0.8, linestyle="--")
    panel.set_title("\n".join(_verdict(one, results.get(one.name)) for one in ones), fontsize=9)
    panel.set_xlabel(_time(ones[0]))
    panel.set_ylabel(textwrap.fill(_label(ones, recording), LINE), fontsize=9)
    panel.grid(alpha=0.3)
    below = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.14), "ncols": 2}  # hides no curve
    panel.legend(fontsize=8, frameon=False, **below)


def _end(one: Expectation, computed: Curve, folder: Path) -> float:
    """Time [s] beyond which there is nothing to be compared, with a little more."""
    known = [float(one.begin), *computed.times[-1:].tolist()]
    reference = reference_curve(one, folder)
    if one.end is not None:
        known.append(one.end)
    elif reference is not None:
        known.append(float(reference.times[-1]))
    return 1.05 * max(known)


def _draw_oscillation(panel: Any, ones: list[Expectation], computed: Curve) -> None:
    """Draw the oscillation with the expected period and decay, of computed amplitude and phase."""
    expected = {one.measure: one for one in ones if one.measure in ("period", "decay")}
    if not expected:
        return
    one = next(iter(expected.values()))
    part = between(computed, one.begin, math.inf if one.end is None else one.end)
    found = fit(part)
    known = {key: value for key, value in ((k, e.value) for k, e in expected.items()) if value}
    if not math.isfinite(found.period) or not known:
        return
    times = np.linspace(part.times[0], part.times[-1], FINE)
    label = f"as fitted to it, but with the expected {' and '.join(known)}"
    values = found._replace(**known).values(times)
    panel.plot(times, values, color=BAND, linewidth=1.2, linestyle="--", label=label)


def _draw_value(panel: Any, one: Expectation, computed: Curve) -> None:
    """Draw a single value as a mark or line with its tolerance, where the curve can show it."""
    assert one.value is not None
    what = "expected" if one.measure in ("at", "crossing") else f"expected {one.measure}"
    label, value = shortened(f"{what}: {one.source}"), one.value
    style = {"color": BAND, "label": label, "markersize": 5, "capsize": 3, "zorder": 3}
    if one.measure == "at":
        panel.errorbar(one.begin, value, yerr=one.within, fmt="o", **style)
    elif one.measure == "crossing":
        panel.errorbar(value, one.level, xerr=one.within, fmt="o", **style)
    elif one.measure in IN_UNIT:
        last = float(computed.times[-1]) if len(computed.times) else one.begin
        span = (one.begin, last if one.end is None else one.end)
        if span[0] >= last:  # the run did not come so far
            return
        if one.measure == "mean":  # about which the curve may swing far beyond what is allowed
            middle = mean(between(computed, *span))
            panel.plot(span, (middle, middle), color=COMPUTED, linewidth=0.8, label="its mean")
        panel.plot(span, (value, value), "--", color=BAND, linewidth=1.2, label=label)
        low, high = value - one.within, value + one.within
        panel.fill_between(span, low, high, color=BAND, alpha=0.25, linewidth=0)


def shortened(text: str) -> str:
    """Beginning of a text, as much as fits into a legend."""
    return "\n".join(textwrap.wrap(text, LINE, max_lines=LINES, placeholder=" …"))


def _time(one: Expectation) -> str:
    """Name of the times, and what they count from."""
    return "t [s]" if one.from_level is None else f"t since {_number(one.from_level)} is passed [s]"


def _label(ones: list[Expectation], recording: Recording) -> str:
    """Name and unit of the curve that some expectations measure."""
    one = ones[0]
    field, units = _field(one, recording), {one.unit for one in ones if one.measure in IN_UNIT}
    if told := next((other.quantity for other in ones if other.quantity), ""):
        return f"{told} [{units.pop() if len(units) == 1 else field.unit}]"
    port, _, what = one.field.replace("_", " ").partition(".")
    name = f"{one.component}: {what if port == 'motion' else f'{port} {what}'}"
    if one.axis is not None:
        name += f" {AXES[one.axis]}" if field.shape == (3,) else f" {one.axis}"
    elif field.shape:
        name = f"|{name}|"
    items = recording.items(one.component, one.field)[0]
    if one.item in ("mean", "max", "min"):
        name += f", {one.item} of {items} items"
    elif items > 1:
        name += f" of item {one.item}"
    if one.moving_mean:
        name += f", mean over {one.moving_mean:g} s"
    if one.offset:
        change = "plus" if one.offset > 0.0 else "less"
        name = f"{name}, {change} {abs(one.offset):g} {field.unit}"
    if abs(one.scale) == 1.0:
        return f"{'−' if one.scale < 0.0 else ''}{name} [{field.unit}]"
    if len(units) == 1:
        return f"{_number(one.scale)} × ({name}) [{units.pop()}]"
    return f"{_number(one.scale)} × ({name} [{field.unit}])"


def _number(value: float) -> str:
    """Write a number with a true minus sign."""
    return f"{value:.4g}".replace("-", "−")


def _field(one: Expectation, recording: Recording) -> Field:
    return fields_of(recording.ports(one.component))[one.field]


def _verdict(one: Expectation, outcome: Outcome | None) -> str:
    """Say what was measured, what was expected, and whether it was met."""
    what = one.measure.replace("relative_rms", "relative RMS distance")
    what = what.replace("rms", "RMS distance")
    if one.measure == "at":
        what = f"at {one.begin:g} s"
    elif one.level is not None:
        what = f"passes {one.level:g} at"
    what = "" if what == one.name else f": {what}"
    if outcome is not None and outcome.not_reached is not None:
        return f"{one.name}{what}: not reached (t = {outcome.not_reached:.4g} s)"
    if outcome is None or outcome.value is None:
        return f"{one.name}{what}: no value: NOT met"
    expected = f"at most {outcome.within:.3g}"
    if one.measure not in DISTANCES:
        expected = f"expected {outcome.reference:.4g} ± {outcome.within:.2g}"
    unit = "" if one.unit == "1" else f" {one.unit}"
    verdict = "met" if outcome.met else "NOT met" if one.required else "not met, not required"
    share = ""
    if outcome.within:
        used = abs(outcome.value - outcome.reference) / outcome.within
        share = f", {used:.0%} of the tolerance used up"
    return f"{one.name}{what} {outcome.value:.4g}, {expected}{unit}: {verdict}{share}"
