"""What another program prints and writes: its version, the time of its steps, its curves."""

import math
import re
from pathlib import Path

import numpy as np

from quintet.coupler.measures.time_series import Curve
from quintet.coupler.study.peers.table import CpuTable, CurveTable
from quintet.interfaces.errors import SceneError


def version_in(text: str, pattern: str) -> str:
    """Version in the output of a program; empty where it prints none."""
    match = re.search(pattern, text)
    return match[1].strip() if match else ""


def cpu_in(text: str, table: CpuTable) -> float:
    """CPU time [s] of a program's steps by what it printed.

    Raises
    ------
    SceneError
        It printed no such time, or several and `repeats` does not say how they count.
    """
    times = _numbers(text, "seconds", table.seconds)
    _check_repeats(times, table.repeats)
    shares = [percent / 100.0 for percent in _numbers(text, "percent", table.percent)]
    without = _numbers(text, "without", table.without)
    if table.repeats == "clock":
        seconds = max(times[-1] - times[0] - sum(without), 0.0)
        return seconds * (shares[-1] if shares else 1.0)
    for key, numbers in (("percent", shares), ("without", without)):
        if numbers and len(numbers) != len(times):
            raise SceneError(
                f"cpu.{key}: it must be printed once for each of the seconds, {len(times)} times; "
                f"found {len(numbers)}. Correct the expression."
            )
    parts = zip(times, without or len(times) * [0.0], shares or len(times) * [1.0], strict=True)
    return sum(max(time - less, 0.0) * share for time, less, share in parts)


def _check_repeats(times: list[float], repeats: str) -> None:
    """Refuse several times that may add up or go on, and a clock that is printed once."""
    if len(times) > 1 and not repeats:
        raise SceneError(
            f"cpu.seconds: the program must print one time; its output has {len(times)}. Say "
            'repeats = "total" where they add up, "clock" where the last less the first counts.'
        )
    if len(times) < 2 and repeats == "clock":
        raise SceneError(
            'cpu.repeats = "clock": the program must print two times or more; its output has one. '
            "Remove repeats, or correct seconds."
        )


def _numbers(text: str, key: str, pattern: str) -> list[float]:
    """Numbers that an expression finds; none without an expression."""
    if not pattern:
        return []
    words = re.findall(pattern, text)
    if not words:
        raise SceneError(
            f"cpu.{key}: the program must print what {pattern!r} describes; its output has "
            "nothing like it. Correct the expression."
        )
    try:
        return [float(word) for word in words]
    except ValueError as error:
        raise SceneError(f"cpu.{key}: its group must be a number; {error}. Correct it.") from error


def curve_in(path: Path, table: CurveTable) -> Curve:
    """Read times [s] and values from columns of numbers; lines of anything else are skipped.

    Raises
    ------
    SceneError
        There is no such file, or it has fewer than two rows, or times that do not increase.
    """
    where = f"output {table.file}"
    if not path.is_file():
        raise SceneError(f"{where}: the program must write it; it did not. See its log.")
    most = max(table.time, table.value)
    rows = [
        (row[table.time], row[table.value])
        for line in path.read_text(errors="replace").splitlines()
        if (row := _row(line)) and len(row) > most
    ]
    if len(rows) < 2:
        raise SceneError(
            f"{where}: it must have two rows or more of {most + 1} numbers; found {len(rows)}. "
            "Correct time and value, or the input."
        )
    times, values = np.array(rows).T
    if not (np.diff(times) > 0.0).all():
        raise SceneError(f"{where}: times in column {table.time} must increase; they do not.")
    return Curve(times, values)


def _row(line: str) -> list[float]:
    """Numbers of a line; none if anything else is on it."""
    try:
        row = [float(word) for word in line.replace(",", " ").split()]
    except ValueError:
        return []
    return row if all(map(math.isfinite, row)) else []
