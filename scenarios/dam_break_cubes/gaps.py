"""Six cubes with and without films in their gaps: ``python scenarios/dam_break_cubes/gaps.py A B``.

A and B are the folders of two runs of the preset `six`, with films and without. Printed are the
mean pressures on the faces of the 5 mm gaps in the lowest row, beside that on its upstream faces,
and where the top cube goes; `gaps.png` beside this file draws both over time.

A face's mean pressure is the push of the water, along the face's normal, on the samples of that
half of the cube, over the face's area.
"""

import sys
from pathlib import Path

import h5py
import matplotlib
import numpy as np

from quintet.interfaces.rotation import matrix

matplotlib.use("Agg")
import matplotlib.pyplot as plt

HERE = Path(__file__).parent
SINCE, UNTIL = 0.75, 1.0  # s: water stands between the cubes, and the pyramid still stands
GAPS = ((0, 1, 1.0), (1, 1, -1.0), (1, 1, 1.0), (2, 1, -1.0))  # cube, axis, side of its face
FRONTS = ((0, 0, -1.0), (1, 0, -1.0), (2, 0, -1.0))
EDGE = 0.15  # m, of a cube
TOP, HALFWAY = 5, 0.225  # m
SMOOTH = 0.02  # s, of the curves


class Run:
    """What a run recorded."""

    def __init__(self, folder: Path) -> None:
        with h5py.File(folder / "recording.h5") as file:
            cubes, water = file["components/cubes"], file["components/water"]
            self.time = cubes["times"][:]
            self.position = cubes["fields/motion.position"][:]
            self.turned = cubes["fields/motion.orientation"][:]
            arm = cubes["static/samples.0.motion.arm"][:]  # m
            body = cubes["static/samples.0.motion.body"][:]
            self.impulse = water["fields/surface_load.force"][:]
        self.area = EDGE**2
        self.arm = [arm[body == cube] for cube in range(self.position.shape[1])]

    def pressure(self, cube: int, axis: int, side: float) -> np.ndarray:
        """Mean pressure [Pa] on a face, over every window."""
        first = sum(len(arm) for arm in self.arm[:cube])
        half = self.arm[cube][:, axis] * side > 0.0
        push = self.impulse[1:, first : first + len(half)][:, half].sum(axis=1)
        normal = side * matrix(self.turned[1:, cube])[:, :, axis]
        return -(push * normal).sum(axis=1) / (np.diff(self.time) * self.area)

    def mean(self, faces: tuple[tuple[int, int, float], ...]) -> np.ndarray:
        """Mean pressure [Pa] on some faces, over every window."""
        return np.mean([self.pressure(*face) for face in faces], axis=0)

    def halfway(self) -> float:
        """When the top cube is halfway down [s]; not a number if it never is."""
        below = np.flatnonzero(self.position[:, TOP, 2] < HALFWAY)
        return float(self.time[below[0]]) if len(below) else float("nan")


def main(folders: list[str]) -> None:
    """Print the numbers and draw the curves."""
    figure, (place, height, gaps) = plt.subplots(1, 3, figsize=(13, 4), layout="constrained")
    reference = np.genfromtxt(HERE / "six_cubes_top_x.csv", delimiter=",")
    place.plot(reference[:, 0], reference[:, 1], "k.", label="experiment")
    for folder, label, line in zip(folders, ("with films", "without"), ("-", "--"), strict=True):
        run = Run(Path(folder))
        middle = 0.5 * (run.time[1:] + run.time[:-1])
        during = (middle > SINCE) & (middle < UNTIL)
        between, before = run.mean(GAPS), run.mean(FRONTS)
        print(
            f"{label}: from {SINCE} to {UNTIL} s {between[during].mean():.0f} Pa in the gaps, "
            f"{before[during].mean():.0f} Pa on the upstream faces; top cube halfway down at "
            f"{run.halfway():.3f} s, x = {run.position[-1, TOP, 0]:.3f} m at {run.time[-1]:.2f} s"
        )
        place.plot(run.time, run.position[:, TOP, 0] - 3.5, "C0" + line, label=label)
        height.plot(run.time, run.position[:, TOP, 2], "C0" + line, label=label)
        window = max(1, round(SMOOTH / (run.time[1] - run.time[0])))
        even = np.ones(window) / window
        for faces, colour, place_name in ((GAPS, "C1", "gaps"), (FRONTS, "C2", "upstream")):
            smooth = np.convolve(run.mean(faces), even, "same")
            gaps.plot(middle, smooth, colour + line, label=f"{place_name}, {label}")
    for axes, name in (
        (place, "top cube's x from the gate [m]"),
        (height, "top cube's height [m]"),
        (gaps, "mean pressure on faces of the lowest row [Pa]"),
    ):
        axes.set(xlabel="time [s]", ylabel=name)
        axes.legend(frameon=False)
    figure.savefig(HERE / "gaps.png", dpi=90)


if __name__ == "__main__":
    main(sys.argv[1:])
