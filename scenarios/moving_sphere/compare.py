"""What a body that moves feels, over what one that is fixed feels.

``python -m quintet.scenarios.moving_sphere.compare FIXED RUN ...``, folders of runs of this scene.
Prints of each the drag along the stream, mean over the second half of the run, with the standard
error of that mean; how far it is off that of the first; the same of the pressure along the wall,
ahead of the shoulder and behind it; and the processor time of a node and stage.
"""

import json
import math
import sys
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from quintet.coupler.files.recording import Recording
from quintet.interfaces.component import Array

SHARE = 0.5  # of a run that is left out at its start
BATCHES = 10  # of the means whose scatter is that of the whole mean
STAGES = 3  # of a step


@dataclass(frozen=True)
class Flight:
    """One run: drag over time, and mean pressure along the wall."""

    name: str
    drag: Array  # (k,) 1, along the relative velocity
    angle: Array  # (w,) rad, from where the stream meets the body, rising
    pressure: Array  # (w,) Pa, mean
    cost: float  # s of a processor, of a node and stage

    @property
    def mean(self) -> float:
        """Mean drag coefficient."""
        return float(self.drag.mean())

    @property
    def error(self) -> float:
        """Standard error of the mean drag, by the scatter of the means of batches."""
        means = [batch.mean() for batch in np.array_split(self.drag, BATCHES)]
        return float(np.std(means, ddof=1) / math.sqrt(BATCHES))

    def pressure_off(self, fixed: "Flight") -> tuple[float, float]:
        """Largest difference of the pressure to another's, over its largest, ahead and behind."""
        other = np.interp(self.angle, fixed.angle, fixed.pressure, period=2.0 * math.pi)
        off = np.abs(self.pressure - other) / fixed.pressure.max()
        ahead = np.abs(self.angle) < 0.5 * math.pi
        return float(off[ahead].max()), float(off[~ahead].max())


def flight(run: Path) -> Flight:
    """Read a run."""
    gas = tomllib.loads((run / "scene.toml").read_text())["components"]["gas"]
    body = gas["moving"]["bodies"][0]
    wind = np.array(gas["initial"].get("velocity", (0.0, 0.0, 0.0)), float)
    wind -= np.array(body.get("velocity", (0.0, 0.0, 0.0)), float)
    along = wind / np.linalg.norm(wind)
    with Recording(run) as recording:
        times = recording.times("gas")
        late = times > SHARE * times[-1] * (1.0 - 1e-9)
        drag = recording.field("gas", "bodies.coefficient")[late, 0] @ along
        pressure = recording.field("gas", "surface.pressure")[late].mean(axis=0)
        angle = recording.field("gas", "surface.angle")[0]
    angle = angle - math.atan2(-along[2], along[0])
    angle = (angle + math.pi) % (2.0 * math.pi) - math.pi
    order = np.argsort(angle)
    timing = json.loads((run / "results.json").read_text())["timing"]["components"]["gas"]
    cost = timing["cpu"] / (timing["steps"] * timing["items"] * STAGES)
    return Flight(run.name, drag, angle[order], pressure[order], cost)


def main(folders: list[str]) -> None:
    """Print a line of each run."""
    flights = [flight(Path(folder)) for folder in folders]
    print(
        "run: drag ± standard error, off the first; pressure off ahead, behind; µs of a node-stage"
    )
    for moving in flights:
        ahead, behind = moving.pressure_off(flights[0])
        error, off = moving.error / moving.mean, moving.mean / flights[0].mean - 1.0
        drag = f"{moving.mean:.4f} ± {error:.2%}, {off:+.2%}"
        print(f"{moving.name}: {drag}; {ahead:.2%}, {behind:.2%}; {1e6 * moving.cost:.2f}")


if __name__ == "__main__":
    main(sys.argv[1:])
