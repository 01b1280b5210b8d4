"""Energy that the processors take, where the machine counts it: RAPL, /sys/class/powercap of Linux.

The counters are those of whole packages, with all that runs on them. They can often be read by the
superuser alone.
"""

import threading
from pathlib import Path

POWERCAP = Path("/sys/class/powercap")
PACKAGES = "intel-rapl:[0-9]*"  # also of AMD; parts of packages have a second number
POLL = 20.0  # s between two readings: counters start anew within minutes
MICRO = 1e-6  # J, unit of the counters


class EnergyMeter:
    """Energy of all processor packages since it was made; it has a thread until it is read."""

    def __init__(self, folder: Path = POWERCAP, poll: float = POLL) -> None:
        """Begin to count; `folder` is that of the counters, `poll` s between two readings."""
        packages = [path for path in sorted(folder.glob(PACKAGES)) if path.name.count(":") == 1]
        self._counters = [path / "energy_uj" for path in packages]
        self._ranges = [_read(path / "max_energy_range_uj") for path in packages]
        self._last = [_read(path) for path in self._counters]
        self._counted = 0.0
        self._lost = not packages or None in [*self._last, *self._ranges]
        self._end, self._poll = threading.Event(), poll
        if not self._lost:
            self._thread = threading.Thread(target=self._count, daemon=True)
            self._thread.start()

    def _count(self) -> None:
        while not self._end.wait(self._poll):
            self._add()

    def _add(self) -> None:
        readings = [_read(path) for path in self._counters]
        for now, before, size in zip(readings, self._last, self._ranges, strict=True):
            if now is None or before is None or size is None:
                self._lost = True
                return
            self._counted += now - before + (size if now < before else 0.0)
        self._last = readings

    def joules(self) -> float | None:
        """End the count; return the energy [J], None where the machine does not count it."""
        if not self._lost:
            self._end.set()
            self._thread.join()
            self._add()
        return None if self._lost else MICRO * self._counted


def _read(path: Path) -> float | None:
    try:
        return float(path.read_text())
    except (OSError, ValueError):
        return None
