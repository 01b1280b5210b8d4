"""Longest stable window of a ball on mooring lines, 2/ω of its stiffest mode.

    python -m quintet.components.mooring_lines.analysis.window_limit SCENE.toml MASS RADIUS X Y Z

prints it for a ball of a mass [kg] and radius [m] at a place [m], with the lines of a scene file,
which are made fast to the ball where the scene has it at first.

Lines pull in the middle of a window, as if the ball moved on evenly until then. With the ball's
motion under that pull a window w multiplies a mode (x, v) by a matrix of determinant 1 and of trace
2 - ω²w²: stable to w = 2/ω, by the lines' own loads around the place.
"""

import sys
import tomllib
from pathlib import Path
from typing import Any

import numpy as np

from quintet.components.mooring_lines.component import MooringLines
from quintet.components.mooring_lines.params import MooringLinesParams
from quintet.components.shared.scene_limits import keys_of
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import read

STEP = 1e-5  # m and rad, of differences


def lines_of(path: Path, mass: float) -> MooringLines:
    """Lines of a scene file, made fast to its first ball, of a mass [kg]."""
    components: dict[str, Any] = tomllib.loads(path.read_text("utf-8"))["components"]
    keys = keys_of({"components": components}, "mooring_lines")
    params, mistakes = read(MooringLinesParams, keys, "lines")
    if params is None:
        raise SceneError(mistakes[0])
    (balls,) = (keys["bodies"] for keys in components.values() if "bodies" in keys)
    lines = MooringLines(params)
    lines.bind({"motion.mass": np.array([mass])}, frozenset())
    lines.prime(motion(np.array([*balls[0]["centre"], 0.0, 0.0, 0.0])))
    return lines


def motion(place: Array) -> dict[str, Array]:
    """Fields of a ball at rest at x, y, z [m], turned by a small rotation vector (3,) [rad]."""
    turn = np.array([1.0, *(0.5 * place[3:])])
    still = np.zeros((1, 3))
    return {
        "motion.position": place[None, :3],
        "motion.orientation": (turn / np.linalg.norm(turn))[None],
        "motion.velocity": still,
        "motion.angular_velocity": still,
    }


def load(lines: MooringLines, place: Array) -> Array:
    """Force [N] and torque [N m] of the lines on a ball at a place (6,) m and rad."""
    lines.take(motion(place))
    lines.step(0.0)
    return lines.state.load[0].copy()


def stiffness(lines: MooringLines, place: Array) -> Array:
    """Minus the derivatives (6, 6) of the load."""
    steps = STEP * np.eye(6)
    rows = [load(lines, place - step) - load(lines, place + step) for step in steps]
    return np.array(rows).T / (2.0 * STEP)


def window_limit(lines: MooringLines, place: Array, mass: float, radius: float) -> float:
    """2/ω [s] of the stiffest mode of a ball at a place (3,) m, as it was at first turned."""
    inertia = np.array([mass] * 3 + [0.4 * mass * radius**2] * 3)
    at = np.concatenate([place, np.zeros(3)])
    squares = np.linalg.eigvals(stiffness(lines, at) / inertia[:, None])
    return float(2.0 / np.sqrt(squares.real.max()))


if __name__ == "__main__":
    numbers = [float(word) for word in sys.argv[2:]]
    ball_lines = lines_of(Path(sys.argv[1]), numbers[0])
    print(f"{window_limit(ball_lines, np.array(numbers[2:]), *numbers[:2]):.3f} s")
