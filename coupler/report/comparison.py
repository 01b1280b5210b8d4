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
from quintet.coupler.measures.evaluation import Outcome, curve, reference_curve
from quintet.coupler.measures.expectation import DISTANCES, Expectation
from quintet.coupler.measures.oscillation import fit as fit_oscillation
from quintet.coupler.measures.time_series import Curve, between, mean
from quintet.coupler.report.axes_units import fit
from quintet.coupler.report.panels import curve_panels, save
from quintet.coupler.report.profiles import Profile, draw_profiles
from quintet.interfaces.component import Field, fields_of

DRAWN = ("rms", "at", "max", "min", "mean")  # measures whose values lie on their curve
IN_UNIT = (*DRAWN, "amplitude", "wave_height")  # measures that have the unit of their curve
PANELS = 12  # at most
COMPUTED, BAND = "tab:blue", "tab:orange"
MARKS = (("o", "black"), ("s", "tab:red"), ("^", "tab:green"), ("D", "tab:purple"))
AXES = "xyz"
OWN_ITEMS = ("motion", "spheres", "points")  # ports of what a component consists of
FINE = 1000  # points of a curve that is drawn by its formula
TITLE = 68  # characters of a line above a panel
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
    profiles: Sequence[Profile] = (),
) -> Path | None:
    """Draw profiles and computed curves against their references, one panel each.

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
    profiles : sequence of Profile
        Of fields beside their exact solution.

    Returns
    -------
    Path or None
        `out`, or None where there is nothing to be drawn.
    """
    curves: dict[tuple[Any, ...], list[Expectation]] = {}
    for expectation in expectations:
        if expectation.csv is not None or values:
            curves.setdefault(_curve_of(expectation), []).append(expectation)
    wanted = sorted(
        curves.values(), key=lambda ones: all(expectation.csv is None for expectation in ones)
    )
    if not wanted and not profiles:
        return None
    if len(wanted) > PANELS:
        title = f"{title}\nthe first {PANELS} of {len(wanted)} curves"
        wanted = wanted[:PANELS]
    results = {outcome.name: outcome for outcome in outcomes}
    figure, every = curve_panels(len(profiles) + len(wanted), title.strip())
    of_profiles, panels = every[: len(profiles)], every[len(profiles) :]
    draw_profiles(of_profiles, profiles)
    for panel, ones in zip(panels, wanted, strict=True):
        _draw(panel, ones, results, recording, Path(folder))
    return save(figure, out)


def _curve_of(expectation: Expectation) -> tuple[Any, ...]:
    """What makes a computed curve: expectations that agree in it share a panel."""
    return (
        *(expectation.component, expectation.field, expectation.item, expectation.axis),
        *(expectation.offset, expectation.scale, expectation.moving_mean, expectation.from_level),
    )


def _draw(
    panel: Any, ones: list[Expectation], results: Outcomes, recording: Recording, folder: Path
) -> None:
    computed = curve(ones[0], recording)
    panel.plot(*computed, color=COMPUTED, linewidth=1.5, label="computed")
    _draw_oscillation(panel, ones, computed)
    drawn: list[str] = []
    last = max(_end(expectation, computed, folder) for expectation in ones)
    for expectation in ones:
        reference = reference_curve(expectation, folder)
        mark, colour = MARKS[len(drawn) % len(MARKS)]
        if reference is None:
            _draw_value(panel, expectation, computed)
        elif expectation.csv not in drawn:
            drawn.append(str(expectation.csv))
            seen = reference.times <= last
            panel.plot(
                reference.times[seen], reference.values[seen], mark, color=colour, markersize=3.5,
                fillstyle="none", label=shortened(expectation.source),
            )  # fmt: skip
        if expectation.level is not None:
            panel.axhline(expectation.level, color="grey", linewidth=0.8, linestyle="--")
    verdicts = (_verdict(expectation, results.get(expectation.name)) for expectation in ones)
    lines = (textwrap.fill(verdict, TITLE, subsequent_indent="  ") for verdict in verdicts)
    panel.set_title("\n".join(lines), fontsize=9)
    fit(panel.xaxis, _time(ones[0]), "s", max(map(abs, panel.get_xlim())))
    name, unit = _label(ones, recording)
    fit(panel.yaxis, textwrap.fill(name, LINE), unit, max(map(abs, panel.get_ylim())))
    panel.yaxis.label.set_fontsize(9)
    panel.grid(alpha=0.3)
    below = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.14), "ncols": 2}  # hides no curve
    panel.legend(fontsize=8, frameon=False, **below)


def _end(expectation: Expectation, computed: Curve, folder: Path) -> float:
    """Time [s] beyond which there is nothing to be compared, with a little more."""
    known = [float(expectation.begin), *computed.times[-1:].tolist()]
    reference = reference_curve(expectation, folder)
    if expectation.end is not None:
        known.append(expectation.end)
    elif reference is not None:
        known.append(float(reference.times[-1]))
    return 1.05 * max(known)


def _draw_oscillation(panel: Any, ones: list[Expectation], computed: Curve) -> None:
    """Draw the oscillation with the expected period and decay, of computed amplitude and phase."""
    expected = {
        expectation.measure: expectation
        for expectation in ones
        if expectation.measure in ("period", "decay")
    }
    if not (expected and len(computed.times)):
        return
    first = next(iter(expected.values()))
    part = between(computed, first.begin, math.inf if first.end is None else first.end)
    wave = fit_oscillation(part)
    known = {key: value for key, value in ((k, e.value) for k, e in expected.items()) if value}
    if not math.isfinite(wave.period) or not known:
        return
    times = np.linspace(part.times[0], part.times[-1], FINE)
    label = f"as fitted to it, but with the expected {' and '.join(known)}"
    values = wave._replace(**known).values(times)
    panel.plot(times, values, color=BAND, linewidth=1.2, linestyle="--", label=label)


def _draw_value(panel: Any, expectation: Expectation, computed: Curve) -> None:
    """Draw a single value as a mark or line with its tolerance, where the curve can show it."""
    assert expectation.value is not None
    prefix = (
        "expected"
        if expectation.measure in ("at", "crossing")
        else f"expected {expectation.measure}"
    )
    label, value = shortened(f"{prefix}: {expectation.source}"), expectation.value
    style = {"color": BAND, "label": label, "markersize": 5, "capsize": 3, "zorder": 3}
    if expectation.measure == "at":
        panel.errorbar(expectation.begin, value, yerr=expectation.within, fmt="o", **style)
    elif expectation.measure == "crossing":
        panel.errorbar(value, expectation.level, xerr=expectation.within, fmt="o", **style)
    elif expectation.measure in DRAWN:
        last = float(computed.times[-1]) if len(computed.times) else expectation.begin
        span = (expectation.begin, last if expectation.end is None else expectation.end)
        if span[0] >= last:  # the run did not come so far
            return
        if (
            expectation.measure == "mean"
        ):  # about which the curve may swing far beyond what is allowed
            middle = mean(between(computed, *span))
            panel.plot(span, (middle, middle), color=COMPUTED, linewidth=0.8, label="its mean")
        panel.plot(span, (value, value), "--", color=BAND, linewidth=1.2, label=label)
        low, high = value - expectation.within, value + expectation.within
        panel.fill_between(span, low, high, color=BAND, alpha=0.25, linewidth=0)


def shortened(text: str) -> str:
    """Beginning of a text, as much as fits into a legend."""
    return "\n".join(textwrap.wrap(text, LINE, max_lines=LINES, placeholder=" …"))


def _time(expectation: Expectation) -> str:
    """Name of the times, and what they count from."""
    return (
        "t"
        if expectation.from_level is None
        else f"t since {_number(expectation.from_level)} is passed"
    )


def _label(ones: list[Expectation], recording: Recording) -> tuple[str, str]:
    """Name and unit of the curve that some expectations measure."""
    expectation = ones[0]
    field, units = (
        _field(expectation, recording),
        {expectation.unit for expectation in ones if expectation.measure in IN_UNIT},
    )
    quantity = next((expected.quantity for expected in ones if expected.quantity), "")
    if quantity and len(units) == 1:
        return quantity, units.pop()
    if quantity and abs(expectation.scale) == 1.0:
        return quantity, field.unit
    name = _plain_name(expectation, field)
    items = recording.items(expectation.component, expectation.field)[0]
    if expectation.item in ("mean", "max", "min"):
        name += f", {expectation.item} of {items} items"
    elif items > 1:
        name += f" of item {expectation.item}"
    if expectation.moving_mean:
        name += f", mean over {expectation.moving_mean:g} s"
    if expectation.offset:
        change = "plus" if expectation.offset > 0.0 else "less"
        name = f"{name}, {change} {abs(expectation.offset):g} {field.unit}"
    if abs(expectation.scale) == 1.0:
        return f"{'−' if expectation.scale < 0.0 else ''}{name}", field.unit
    if len(units) == 1:
        return f"{_number(expectation.scale)} × ({name})", units.pop()
    return f"{_number(expectation.scale)} × ({name} in {field.unit})", "1"


def _plain_name(expectation: Expectation, field: Field) -> str:
    """A field in words, with its axis and its component, and with the port that is not all of it.

    A port says where or of what a field is, unless it holds the items of a component.
    """
    port, _, quantity = expectation.field.replace("_", " ").partition(".")
    if expectation.axis is not None:
        quantity += f" {AXES[expectation.axis]}" if field.shape == (3,) else f" {expectation.axis}"
    elif field.shape:
        quantity = f"|{quantity}|"
    last = port.split()[-1]
    at = "" if port in OWN_ITEMS else f" at {last}" if last.startswith("gauge") else f", {port}"
    return f"{quantity}{at} of {expectation.component}"


def _number(value: float) -> str:
    """Write a number with a true minus sign."""
    return f"{value:.4g}".replace("-", "−")


def _field(expectation: Expectation, recording: Recording) -> Field:
    return fields_of(recording.ports(expectation.component))[expectation.field]


def _verdict(expectation: Expectation, outcome: Outcome | None) -> str:
    """Say what was measured, what was expected, and whether it was met."""
    measure = expectation.measure.replace("relative_rms", "relative RMS distance")
    measure = measure.replace("rms", "RMS distance")
    if expectation.measure == "at":
        measure = f"at {expectation.begin:g} s"
    elif expectation.level is not None:
        measure = f"passes {expectation.level:g} at"
    measure = "" if measure == expectation.name else f": {measure}"
    if outcome is not None and outcome.not_reached is not None:
        return f"{expectation.name}{measure}: not reached (t = {outcome.not_reached:.4g} s)"
    if outcome is None or outcome.value is None:
        return f"{expectation.name}{measure}: no value: NOT met"
    expected = f"at most {outcome.within:.3g}"
    if expectation.measure not in DISTANCES:
        expected = f"expected {outcome.reference:.4g} ± {outcome.within:.2g}"
    unit = "" if expectation.unit == "1" else f" {expectation.unit}"
    verdict = (
        "met" if outcome.met else "NOT met" if expectation.required else "not met, not required"
    )
    share = ""
    if outcome.within:
        used = abs(outcome.value - outcome.reference) / outcome.within
        share = f", {used:.0%} of the tolerance used up"
    return f"{expectation.name}{measure} {outcome.value:.4g}, {expected}{unit}: {verdict}{share}"
