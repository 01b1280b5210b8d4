"""Gas and dust behind the shock: ``python -m quintet.scenarios.dusty_shock.profile RUN``.

RUN is the folder of a run; draws `profile.png` there: velocities, temperatures and pressure over
the distance behind the shock, with the exact relaxation.
"""

import sys
from pathlib import Path

import matplotlib
import numpy as np

from quintet.coupler.files.recording import Recording
from quintet.interfaces.component import Array
from quintet.scenarios.dusty_shock.relaxation import SOUND, relax

matplotlib.use("Agg")
import matplotlib.pyplot as plt

MACH, MET = 1.6, 100.0  # 1, m/s: a grain that is as fast has met the shock


def front(position: Array, velocity: Array) -> float:
    """Place [m] of the shock: of where grains have a given speed, less how far behind that is."""
    order = np.argsort(position)
    x, v = position[order], velocity[order]
    last = int(np.flatnonzero(v > MET)[-1])
    place = x[last] + (v[last] - MET) / (v[last] - v[last + 1]) * (x[last + 1] - x[last])
    exact = relax(MACH * SOUND, 1e-3)
    return float(place + np.interp(MET, exact.velocity, exact.behind))


def main(run: str) -> None:
    """Draw the last instant."""
    with Recording(Path(run)) as recording:
        dust = {n: recording.field("dust", f"spheres.{n}")[-1] for n in ("position", "velocity")}
        warm = recording.field("dust", "spheres.temperature")[-1]
        names = ("position", "velocity", "temperature", "pressure")
        gas = {name: recording.field("gas", f"probes.{name}")[-1] for name in names}
    x, v = dust["position"][:, 0], dust["velocity"][:, 0]
    shock, exact = front(x, v), relax(MACH * SOUND, 4e-3)
    figure, axes = plt.subplots(1, 3, figsize=(13, 4), sharex=True)
    curves = (
        ("velocity [m/s]", gas["velocity"][:, 0], v, exact.gas[:, 0], exact.velocity),
        ("temperature [K]", gas["temperature"], warm, exact.gas[:, 1], exact.temperature),
        ("pressure [bar]", gas["pressure"] / 1e5, None, exact.gas[:, 2] / 1e5, None),
    )
    for axis, (name, of_gas, of_dust, exact_gas, exact_dust) in zip(axes, curves, strict=True):
        axis.plot(exact.behind, exact_gas, "k", linewidth=1.0, label="exact")
        axis.plot(shock - gas["position"][:, 0], of_gas, "o", label="gas")
        if of_dust is not None:
            axis.plot(exact.behind, exact_dust, "k", linewidth=1.0)
            axis.plot(shock - x, of_dust, ".", markersize=3, label="dust")
        axis.set(xlim=(-0.05, 0.5), xlabel="behind the shock [m]", ylabel=name)
        axis.legend()
    figure.tight_layout()
    figure.savefig(Path(run) / "profile.png", dpi=90)


if __name__ == "__main__":
    main(sys.argv[1])
