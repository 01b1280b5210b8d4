"""What the results of a run say, as tables and sentences, for a screen or a page."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from rich.text import Text

MASS_TOLD = 1e-3  # of a component's mass, a change that is told
ROUNDING = 1e-9  # of the energy that was turned over


@dataclass(frozen=True)
class TableOfRun:
    """A table; it may have no rows.

    Attributes
    ----------
    title : str
    names : list of str
        Of the columns.
    left : int
        So many columns hold text, the others numbers.
    rows : list of lists
        Of cells: texts, which may have a style, and numbers.
    """

    title: str
    names: list[str]
    left: int
    rows: list[list[Any]]


def expectations(run: Mapping[str, Any]) -> TableOfRun:
    """What was expected, and what came of it."""
    outcomes = run.get("expect") or []
    # A column that few runs have.
    has_bars = any(outcome.get("error_bar") is not None for outcome in outcomes)
    bar = {"error_bar": "± by coupling"} if has_bars else {}
    keys = {"value": "value", **bar, "reference": "reference", "within": "within"}
    rows = [
        [
            met(outcome),
            outcome.get("name", "?"),
            outcome.get("unit", ""),
            *(number(outcome.get(key)) for key in keys),
        ]
        for outcome in outcomes
    ]
    names = ["", "expectation", "unit", *keys.values()]
    return TableOfRun("Expectations", names, 3, rows)


def references(run: Mapping[str, Any]) -> TableOfRun:
    """Where the reference of each expectation is from."""
    keys = ("name", "reference_kind", "read_from", "source", "doi", "licence")
    rows = [[str(outcome.get(key) or "-") for key in keys] for outcome in run.get("expect") or []]
    names = ["expectation", "kind", "read from", "source", "DOI", "licence of the data"]
    return TableOfRun("References", names, len(names), rows)


def error_bars(run: Mapping[str, Any]) -> TableOfRun:
    """Error that the coupling makes in each watched quantity: in a window, and in the value."""
    bars = run.get("error_bar") or {}
    rows = [
        [row["name"], *(number(row[key]) for key in ("window", "value", "order"))]
        for row in bars.get("watched") or []
    ]
    share = f"{100.0 * bars.get('confidence', 0.0):g} %"
    names = ["quantity", "± of a window", "± of the value", "order"]
    return TableOfRun(f"Error by the coupling, with {share} confidence", names, 1, rows)


def error_bar_notes(run: Mapping[str, Any]) -> str:
    """From how many windows the error bars are, and why there are no more."""
    bars = run.get("error_bar")
    if not bars:
        return ""
    text = f"Error bars: from {len(bars['windows'])} of {run.get('windows', 0)} windows"
    return f"{text}; then sampling ended, for {bars['skipped']}" if bars["skipped"] else text


def met(outcome: Mapping[str, Any]) -> Text:
    """Whether an expectation is met."""
    text = "met" if outcome.get("met") else "not met"
    if outcome.get("not_reached") is not None:
        text = f"not reached (t = {number(outcome['not_reached'])} s)"
    if not outcome.get("required", True):
        return Text(f"{text}, not required")
    return Text(text, style="green" if outcome.get("met") else "red")


# What of a link shows that it carries what these are of, also where they are 0.
CARRIED_AS = {
    "momentum_residual": "impulse",
    "heat_residual": "heat",
    "work_given": "turnover",
    "work_taken": "turnover",
    "energy_residual": "turnover",
}


def _carries(link: Mapping[str, Any], key: str) -> bool:
    """Whether a sum of a link is not 0, or is 0 although the link carries what it is of."""
    values = (link.get(key), link.get(CARRIED_AS.get(key, key)))
    return any(any(value) if isinstance(value, list) else bool(value) for value in values)


def _sum_of(link: Mapping[str, Any], key: str) -> str:
    return number(link.get(key)) if _carries(link, key) else "-"


def ledger(run: Mapping[str, Any]) -> TableOfRun:
    """One column for each link; a row for what any of them carries."""
    links = (run.get("ledger") or {}).get("links") or []
    keys = dict.fromkeys(key for link in links for key in link if key != "link")
    rows = [
        [key.replace("_", " "), *(_sum_of(link, key) for link in links)]
        for key in keys
        if any(_carries(link, key) for link in links)
    ]
    return TableOfRun("Ledger", ["", *(link.get("link", "?") for link in links)], 1, rows)


ENERGIES = {  # change = outside + links + heat - lost + unexplained
    "change": "change",
    "outside": "work from outside",
    "links": "work over links",
    "heat": "heat over links",
    "lost": "lost (dissipated)",
    "unexplained": "unexplained",
    "coupling": "of it by the coupling",
    "gained": "largest rise unexplained",
}


def energies(run: Mapping[str, Any]) -> TableOfRun:
    """The energy balance in J and per cent: a column for the run and each of its components.

    No rows where no component reports its energies.
    """
    balance = (run.get("ledger") or {}).get("energy_balance")
    if not balance:
        return TableOfRun("", [], 1, [])
    scale, components = balance["scale"], balance["components"]
    columns = components if len(components) == 1 else {"run": balance["run"], **components}
    rows = [
        [label, *(_share(column[key], scale) for column in columns.values())]
        for key, label in ENERGIES.items()
        if any(abs(column[key] or 0.0) > ROUNDING * scale for column in columns.values())
    ]
    return TableOfRun(f"Energy [J], 100 % = {number(scale)} J", ["", *columns], 1, rows)


def _share(energy: float | None, scale: float) -> str:
    """An energy [J] and what per cent of the scale it is; a dash where it is not known."""
    if energy is None:
        return "-"
    if abs(energy) <= ROUNDING * scale:
        return "0"
    return f"{energy:.3g} ({float(f'{100.0 * energy / scale:.2g}'):g} %)"


def mass_changes(run: Mapping[str, Any]) -> str:
    """Which components' masses changed, by more than what is negligible."""
    drifts = (run.get("ledger") or {}).get("mass_drift") or {}
    changes = []
    for name, drift in drifts.items():
        share = drift["relative"]
        if share is None:
            changes.append(f"mass of {name} changed by {drift['kg']:+.3g} kg from none")
        elif abs(share) > MASS_TOLD:
            changes.append(
                f"mass of {name} changed by {100.0 * share:+.2g} % ({drift['kg']:+.3g} kg)"
            )
    return "Mass: " + ", ".join(changes) if changes else ""


def mass_balances(run: Mapping[str, Any]) -> list[str]:
    """What came to each component and what left it, by reason, where anything did."""
    balances = (run.get("ledger") or {}).get("mass_balance") or {}
    return [
        f"Mass of {name}: "
        + ", ".join(f"{mass:+.6g} kg {reason}" for reason, mass in balance["kg"].items())
        + f"; {balance['now']:.6g} kg now, which differs from their sum by "
        f"{balance['residual']:.1g} of it"
        for name, balance in balances.items()
        if len(balance["kg"]) > 1
    ]


def timing(run: Mapping[str, Any]) -> TableOfRun:
    """Seconds, steps and items of each component."""
    components = (run.get("timing") or {}).get("components") or {}
    rows = [
        [
            name,
            *(number(times.get(key)) for key in ("build", "compute", "cpu", "wait")),
            times.get("steps", "-"),
            times.get("items", "-"),
            number(_rate(times)),
        ]
        for name, times in components.items()
    ]
    seconds = [f"{name} [s]" for name in ("build", "compute", "CPU", "wait")]
    names = ["component", *seconds, "steps", "items", "item-steps/s"]
    return TableOfRun("Timing", names, 1, rows)


def _rate(times: Mapping[str, Any]) -> float | None:
    """Items stepped per second of computing time."""
    compute = times.get("compute")
    return times.get("steps", 0) * times.get("items", 0) / compute if compute else None


def time_shares(run: Mapping[str, Any]) -> str:
    """Where the time of the whole run went, its memory, and repeated windows."""
    timing = run.get("timing") or {}
    times = {k: v for k, v in timing.items() if k not in ("components", "memory")}
    text = "Time: " + ", ".join(f"{k} {number(v)} s" for k, v in times.items()) if times else ""
    text += f"; memory {timing['memory'] / 1e6:.0f} MB" if timing.get("memory") else ""
    repetitions = run.get("repetitions")
    text += f"; windows repeated {repetitions} times" if repetitions else ""
    lacking = run.get("unconverged")
    return text + (f"; {lacking} windows did not converge" if lacking else "")


def number(value: Any) -> str:
    """Four digits of a number; a dash where there is none."""
    if value is None:
        return "-"
    if isinstance(value, list):
        return " ".join(f"{part:.3g}" for part in value)
    return f"{value:.4g}" if isinstance(value, (int, float)) else str(value)
