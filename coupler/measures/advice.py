"""Who waits for whom in a coupled run, and how many cores each component should get.

Law: of a component's computing time on one core, t₁, a share s gains nothing from more cores,

    t(p) = t₁ (s + (1 - s) / p),

Amdahl (1967), AFIPS Conf. Proc. 30, 483. Members that step one after the other each use all cores,
and their times add up; of members that step at once the slowest counts, and the cores are divided
among them. Time of messages, of the coupler and of repeated windows is not in the law, nor is
memory bandwidth, which components that compute at once share.

A component that ran with p > 1 threads shows its share: its processor time over its computing time
is the mean number k of cores that it used, so that 1 / k = s + (1 - s) / p. Other programs on the
cores make k too small, and with k < 1 nothing is learned from it, as from a run with one thread;
then s is what the kind plans (`Plan.serial`). The cores of a component are its ranks times their
threads; which of both shortens it more is not in the law.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Union

from quintet.coupler.coupling.plan import CouplingPlan

NEGLIGIBLE = 0.01  # of a run's time: for less no component gets more cores
Times = Mapping[str, float]  # s, by component


@dataclass(frozen=True, slots=True)
class Load:
    """Computing time of a component on some cores.

    Parameters
    ----------
    seconds : float, s
        Measured or planned.
    threads : int
        Of each rank, at these seconds.
    serial : float
        Share of the time on one core that more cores do not shorten, 0 to 1.
    measured : bool
        Whether the share was measured, not planned.
    ranks : int
        Among which the component is divided, at these seconds.
    divisible : bool
        Whether its kind can own several ranks.
    """

    seconds: float
    threads: int = 1
    serial: float = 1.0
    measured: bool = False
    ranks: int = 1
    divisible: bool = False

    @property
    def cores(self) -> int:
        """Cores that it had."""
        return self.ranks * self.threads

    def on(self, cores: int) -> float:
        """Time on a number of cores [s]."""
        return self.seconds * _relative(self.serial, cores) / _relative(self.serial, self.cores)


@dataclass(frozen=True, slots=True)
class Stage:
    """Components and stages that follow each other, or run at once."""

    parts: tuple[Union["Stage", str], ...]
    at_once: bool


def _relative(serial: float, cores: int) -> float:
    """Time on some cores over that on one."""
    return serial + (1.0 - serial) / cores


def serial_share(seconds: float, processor: float, cores: int) -> float | None:
    """Share that gains nothing from more cores, of a measured run; None if it is not known.

    Parameters
    ----------
    seconds : float, s
        Computing time by the clock, on `cores` cores.
    processor : float, s
        Processor time of all threads in it.
    """
    if cores < 2 or seconds <= 0.0 or processor < seconds:
        return None
    return max((cores * seconds / processor - 1.0) / (cores - 1.0), 0.0)


def stages(plan: CouplingPlan, processes: bool = True) -> Stage:
    """Lay out who computes after whom, and who at once, in a coupling and its groups.

    The coupler steps groups of a parallel coupling one after the other, while its other members
    compute. Within one process nothing runs at once.
    """
    if plan.scheme != "parallel" or not processes:
        parts = (_part(name, inner, processes) for name, inner in plan.members.items())
        return Stage(tuple(parts), False)
    groups = tuple(stages(inner, processes) for inner in plan.inner())
    components = [name for name, inner in plan.members.items() if inner is None]
    return Stage((*components, *([Stage(groups, False)] if groups else [])), True)


def _part(name: str, inner: CouplingPlan | None, processes: bool) -> Stage | str:
    return name if inner is None else stages(inner, processes)


def duration(part: Stage | str, times: Times) -> float:
    """Time that a component or a stage takes [s]."""
    if isinstance(part, str):
        return times[part]
    each = [duration(inner, times) for inner in part.parts]
    return max(each, default=0.0) if part.at_once else sum(each)


def critical_path(part: Stage | str, times: Times) -> dict[str, float]:
    """Components that determine the time of a stage, and how much of it each takes [s]."""
    if isinstance(part, str):
        return {part: times[part]}
    inner = part.parts
    if part.at_once:
        inner = (max(inner, key=lambda each: duration(each, times)),)
    return {name: time for each in inner for name, time in critical_path(each, times).items()}


def waits(part: Stage | str, times: Times) -> dict[str, dict[str, float]]:
    """Time for which each component waits, by whom it waits for [s].

    Of members that step at once these are differences of sums over the run: at least so much.
    """
    if isinstance(part, str):
        return {part: {}}
    result: dict[str, dict[str, float]] = {}
    for inner in part.parts:
        outside = _lateness(part, inner, times)
        result |= {name: {**by, **outside} for name, by in waits(inner, times).items()}
    return result


def _lateness(stage: Stage, part: Stage | str, times: Times) -> dict[str, float]:
    """Time for which a part of a stage waits for the components of the other parts [s]."""
    late: dict[str, float] = {}
    if not stage.at_once:
        for other in stage.parts:
            late |= critical_path(other, times) if other != part else {}
        return late
    longest = duration(stage, times)
    share = (longest - duration(part, times)) / longest if longest > 0.0 else 0.0
    path = critical_path(stage, times) if share > 0.0 else {}
    return {name: share * time for name, time in path.items()}


def shortest(part: Stage | str, loads: Mapping[str, Load], cores: int) -> dict[str, int]:
    """Cores of each component with which a stage takes the shortest time."""
    if isinstance(part, str):
        return {part: cores}
    shares = [cores] * len(part.parts)
    if part.at_once:
        shares = _divided(part, loads, cores)
    pairs = zip(part.parts, shares, strict=True)
    return {n: p for inner, share in pairs for n, p in shortest(inner, loads, share).items()}


def _divided(stage: Stage, loads: Mapping[str, Load], cores: int) -> list[int]:
    """Cores of parts that run at once: each one, the others to whoever is slowest then."""
    shares = [1] * len(stage.parts)

    def time(number: int, more: int = 0) -> float:
        part, share = stage.parts[number], shares[number] + more
        return duration(part, times_on(loads, shortest(part, loads, share)))

    for _ in range(cores - len(shares)):
        slowest = max(range(len(shares)), key=time)
        if time(slowest, 1) >= time(slowest):
            break
        shares[slowest] += 1
    return shares


def times_on(loads: Mapping[str, Load], cores: Mapping[str, int]) -> dict[str, float]:
    """Time of each component on its cores [s]."""
    return {name: loads[name].on(number) for name, number in cores.items()}


def advised_cores(stage: Stage, loads: Mapping[str, Load], cores: int) -> dict[str, int]:
    """Fewest cores of each component with which a run takes at most 1 % over its best time."""
    best = shortest(stage, loads, cores)
    slack = NEGLIGIBLE * duration(stage, times_on(loads, best)) / len(loads)
    return {
        name: next(
            fewer
            for fewer in range(1, number + 1)
            if loads[name].on(fewer) <= loads[name].on(number) + slack
        )
        for name, number in best.items()
    }


def advice(stage: Stage, loads: Mapping[str, Load], cores: int) -> dict[str, Any]:
    """Waits now, and advised threads and ranks with the time that they take, for results.json.

    Parameters
    ----------
    stage : Stage
        All components.
    loads : mapping of Load
        By component.
    cores : int
        That there are.
    """
    now = {name: load.seconds for name, load in loads.items()}
    cores_of = advised_cores(stage, loads, cores)
    then = times_on(loads, cores_of)
    if duration(stage, now) <= (1.0 + NEGLIGIBLE) * duration(stage, then):
        cores_of, then = {name: load.cores for name, load in loads.items()}, now
    return {
        "cores": cores,
        "seconds": duration(stage, now),
        "advised_seconds": duration(stage, then),
        "waits": {name: by for name, by in waits(stage, now).items() if by},
        "components": {
            name: _row(load, cores_of[name], then[name]) for name, load in loads.items()
        },
    }


def _row(load: Load, cores: int, seconds: float) -> dict[str, Any]:
    ranks = load.ranks if cores >= load.ranks else 1
    return {
        "ranks": load.ranks,
        "threads": load.threads,
        "advised_ranks": ranks,
        "advised_threads": max(1, cores // ranks),
        "seconds": load.seconds,
        "advised_seconds": seconds,
        "serial": load.serial,
        "serial_measured": load.measured,
        "divisible": load.divisible,
    }


def loads_of(advised: Mapping[str, Any]) -> dict[str, Load]:
    """Loads of components, of an advice as it stands in results.json."""
    return {
        name: Load(
            row["seconds"],
            row["threads"],
            row["serial"],
            row["serial_measured"],
            row["ranks"],
            row["divisible"],
        )
        for name, row in advised["components"].items()
    }


def sentences(advised: Mapping[str, Any]) -> list[str]:
    """Write an advice, as it stands in results.json, for people."""
    waited = [
        f"{name} " + " and ".join(f"{time:.3g} s for {other}" for other, time in by.items())
        for name, by in advised["waits"].items()
    ]
    rows = advised["components"]
    changes = [text for name, row in rows.items() if (text := _change(name, row))]
    head = f"Advice for {advised['cores']} cores"
    gain = f"{advised['advised_seconds']:.3g} s of computing instead of {advised['seconds']:.3g} s"
    sentence = f"{head}: {', '.join(changes)}: {gain} (Amdahl's law)" if changes else ""
    return [
        *([f"Waits: {'; '.join(waited)}"] if waited else []),
        sentence
        or f"{head}: as they are, {', '.join(_now(name, row) for name, row in rows.items())}",
    ]


def _change(name: str, row: Mapping[str, Any]) -> str:
    now = _cores(row["ranks"], row["threads"])
    then = _cores(row["advised_ranks"], row["advised_threads"])
    if now == then:
        return ""
    keys = " and ".join(k for k in ("ranks", "threads") if row[k] != row[f"advised_{k}"])
    if row["divisible"] and row["advised_ranks"] == 1 < row["advised_threads"]:
        then += f" or {row['advised_threads']} ranks"
        keys = "threads or ranks"
    source = "measured" if row["serial_measured"] else "planned"
    share = f"serial share {row['serial']:.2g}, {source}"
    return f"{name} {then} instead of {now} (components.{name}.{keys}; {share})"


def _now(name: str, row: Mapping[str, Any]) -> str:
    return f"{name} {_cores(row['ranks'], row['threads'])}"


def _cores(ranks: int, threads: int) -> str:
    text = f"{threads} thread{'s' if threads > 1 else ''}"
    return f"{ranks} ranks of {text}" if ranks > 1 else text
