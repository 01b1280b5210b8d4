"""Error of integrators against time: ``python -m quintet.scenarios.lattice_in_motion.precision S``.

S is the folder that `quintet study lattice_in_motion --out S` left. Prints how far the points are
from where they should be, root mean square over the spacing, and draws `precision.png` in S.
"""

import json
import math
import sys
import tomllib
from pathlib import Path

import matplotlib
import numpy as np

from quintet.coupler.files.recording import Recording

matplotlib.use("Agg")
import matplotlib.pyplot as plt

EXACT = Path(__file__).with_name("end.csv")
LIMIT = {"velocity_verlet": 2.0, "yoshida": 1.5734}  # greatest stable step times the frequency


def read(folder: Path) -> tuple[str, float, float, float, float]:
    """Integrator, step times the highest frequency, error over the spacing, audit, seconds."""
    cube = tomllib.loads((folder / "scene.toml").read_text())["components"]["cube"]
    with Recording(folder) as recording:
        end = recording.field("cube", "points.position")[-1]
        audit = abs(float(recording.field("cube", "energies.audit")[-1, 0]))
    gap = end - np.loadtxt(EXACT, delimiter=",", comments="#")
    error = math.sqrt((gap**2).sum(axis=1).mean()) / cube["lattice"]["spacing"]
    timing = json.loads((folder / "results.json").read_text())["timing"]["components"]["cube"]
    integrator = cube.get("integrator", "velocity_verlet")
    return integrator, cube["courant"] * LIMIT[integrator], error, audit, timing["cpu"]


def main(study: str) -> None:
    """Print and draw."""
    rows = sorted(read(path.parent) for path in Path(study).rglob("results.json"))
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4))
    print(
        "integrator       step x frequency  error of places / a  energy audit  processor time [s]"
    )
    for integrator in LIMIT:
        runs = [row for row in rows if row[0] == integrator]
        for _, step, error, audit, seconds in runs:
            print(f"{integrator:16} {step:16.3f} {error:20.2e} {audit:13.2e} {seconds:19.3f}")
        spent = [run[4] for run in runs]
        left.loglog(spent, [run[2] for run in runs], "o-", label=integrator)
        right.loglog(spent, [run[3] for run in runs], "o-", label=integrator)
        for run in runs:
            left.annotate(f"{run[1]:.2g}", (run[4], run[2]), fontsize=7)
    left.set(ylabel="error of places / a (labels: step x frequency)")
    right.set(ylabel="energy that is missing")
    for panel in (left, right):
        panel.set_xlabel("processor time [s]")
        panel.legend()
    figure.tight_layout()
    figure.savefig(Path(study) / "precision.png", dpi=90)


if __name__ == "__main__":
    main(sys.argv[1])
