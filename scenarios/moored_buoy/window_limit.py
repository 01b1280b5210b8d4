"""Longest stable window of the buoy, 2/ω: ``python scenarios/moored_buoy/window_limit.py``.

The chains pull in the middle of a window, as if the buoy moved on evenly until then. With the
buoy's motion under that pull a window w multiplies a mode (x, v) by a matrix of determinant 1 and
of trace 2 - ω²w²: stable to w = 2/ω. ω is that of the stiffest mode, by the chains' loads around
rest.
"""

import tomllib
from pathlib import Path

import numpy as np

from quintet.components.mooring_lines.component import MooringLines
from quintet.components.mooring_lines.params import MooringLinesParams
from quintet.interfaces.component import Array
from quintet.interfaces.params import read

MASS, RADIUS = 36.75, 0.2  # kg, m
LIFT = np.array([0.0, 0.0, 132.6, 0.0, 0.0, 0.0])  # N, N m
INERTIA = np.array([MASS] * 3 + [0.4 * MASS * RADIUS**2] * 3)  # kg, kg m2
BEGUN = np.array([0.0, 0.0, 3.1])  # m, where the chains are made fast
STEP = 1e-5  # m, of differences; over the radius a rotation


def chains() -> MooringLines:
    """Chains of the scene, made fast to the buoy."""
    scene = tomllib.loads(Path(__file__).with_name("scene.toml").read_text())
    table = {key: value for key, value in scene["components"]["chains"].items() if key != "kind"}
    params, mistakes = read(MooringLinesParams, table, "chains")
    assert params is not None, mistakes
    lines = MooringLines(params)
    lines.bind({"motion.mass": np.array([MASS])}, frozenset())
    lines.prime(motion(np.array([0.15, 0.0, 3.1, 0.0, 0.0, 0.0])))
    return lines


def motion(place: Array) -> dict[str, Array]:
    """Fields of a buoy at rest at x, y, z [m], turned by a small rotation vector."""
    turn = np.array([1.0, *(0.5 * place[3:])])
    still = np.zeros((1, 3))
    return {
        "motion.position": place[None, :3],
        "motion.orientation": (turn / np.linalg.norm(turn))[None],
        "motion.velocity": still,
        "motion.angular_velocity": still,
    }


def load(lines: MooringLines, place: Array) -> Array:
    """Force [N] and torque [N m] of the chains, and of the buoy's lift."""
    lines.take(motion(place))
    lines.step(0.0)
    return np.asarray(lines.state.load[0] + LIFT)


def stiffness(lines: MooringLines, place: Array) -> Array:
    """Derivatives (6, 6) of the load."""
    steps = STEP * np.eye(6)
    rows = [load(lines, place - step) - load(lines, place + step) for step in steps]
    return np.array(rows).T / (2.0 * STEP)


def rest(lines: MooringLines) -> Array:
    """Place of rest, by Newton's method."""
    place = np.concatenate([BEGUN, np.zeros(3)])
    for _ in range(20):
        place = place + np.linalg.solve(stiffness(lines, place), load(lines, place))
    return place


def window_limit(lines: MooringLines, place: Array) -> float:
    """2/ω [s] of the stiffest mode at a place."""
    squares = np.linalg.eigvals(stiffness(lines, place) / INERTIA[:, None])
    return float(2.0 / np.sqrt(squares.real.max()))


def main() -> None:
    """Print the place of rest and the longest window."""
    lines = chains()
    place = rest(lines)
    print(f"at rest at z = {place[2]:.3f} m: {window_limit(lines, place):.3f} s")
    for x, z in ((0.15, 3.1), (0.0, 3.2), (0.05, 3.35)):
        at = np.array([x, 0.0, z, 0.0, 0.0, 0.0])
        print(f"at ({x}, 0, {z}) m: {window_limit(lines, at):.3f} s")
    print(np.sort(np.sqrt(np.linalg.eigvals(stiffness(lines, place) / INERTIA[:, None]))))


if __name__ == "__main__":
    main()
