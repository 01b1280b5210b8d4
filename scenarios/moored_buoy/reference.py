"""Motion of the buoy by another program: ``python scenarios/moored_buoy/reference.py``.

It writes surge.csv, heave.csv and tension.csv beside it.

The pull of the lines is MoorPy's (Hall et al., NREL, 2021), which quintet does not need
(``pip install moorpy==1.3.0 scipy``); the motion is integrated by SciPy's DOP853 to 1e-10.
"""

from pathlib import Path

import numpy as np

END, INTERVAL = 8.0, 0.05  # s
MASS, RADIUS = 36.75, 0.2  # kg, with the water that moves with it; m
LIFT = 132.6 / MASS  # m/s2, net buoyancy over the mass
LENGTH, STIFFNESS, WEIGHT = 7.2, 2.0e4, 8.0  # m, N, N/m
PLACE = np.array([0.15, 0.0, 3.1])  # m, of the buoy as it is let go
ANGLES = np.radians([0.0, 120.0, 240.0])
ANCHORS = 6.0 * np.column_stack([np.cos(ANGLES), np.sin(ANGLES), 0.0 * ANGLES])
# Where lines are made fast: on a circle at half of the radius below the middle.
ARMS = np.column_stack([0.1732 * np.cos(ANGLES), 0.1732 * np.sin(ANGLES), -0.1 + 0.0 * ANGLES])


def matrix(quaternion: np.ndarray) -> np.ndarray:
    """Rotation matrix of a unit quaternion w, x, y, z."""
    from scipy.spatial.transform import Rotation  # of this script alone

    return Rotation.from_quat(np.roll(quaternion, -1)).as_matrix()


def loads(place: np.ndarray, quaternion: np.ndarray) -> tuple[np.ndarray, np.ndarray, list[float]]:
    """Force [N], torque [N m] and tensions [N] of the lines."""
    from moorpy.Catenary import catenary  # of this script alone

    force, torque, tensions = np.zeros(3), np.zeros(3), []
    for anchor, start in zip(ANCHORS, ARMS, strict=True):
        arm = matrix(quaternion) @ start
        span = place + arm - anchor
        level = float(np.hypot(*span[:2]))
        pull = catenary(level, span[2], LENGTH, STIFFNESS, WEIGHT, CB=0, Tol=1e-12, MaxIter=200)
        line = np.array([*(pull[2] * span[:2] / level), pull[3]])
        force, torque = force + line, torque + np.cross(arm, line)
        tensions.append(float(np.linalg.norm(line)))
    return force, torque, tensions


def rates(_: float, state: np.ndarray) -> np.ndarray:
    """Of place, velocity, quaternion and angular velocity; a ball's inertia is 2/5 m r²."""
    velocity, quaternion, spin = state[3:6], state[6:10] / np.linalg.norm(state[6:10]), state[10:]
    force, torque = loads(state[:3], quaternion)[:2]
    w, vector = quaternion[0], quaternion[1:]
    turn = 0.5 * np.array([-spin @ vector, *(w * spin + np.cross(spin, vector))])
    acceleration = force / MASS + [0.0, 0.0, LIFT]
    return np.concatenate([velocity, acceleration, turn, torque / (0.4 * MASS * RADIUS**2)])


def main() -> None:
    """Write surge and heave of the buoy, and the tension of the first chain, over time."""
    from scipy.integrate import solve_ivp  # of this script alone

    start = np.concatenate([PLACE, np.zeros(3), [1.0, 0.0, 0.0, 0.0], np.zeros(3)])
    times = np.arange(0.0, END + 1e-9, INTERVAL)
    path = solve_ivp(
        rates, (0.0, END), start, method="DOP853", t_eval=times, rtol=1e-10, atol=1e-12
    )
    quaternions = path.y[6:10] / np.linalg.norm(path.y[6:10], axis=0)
    pairs = zip(path.y[:3].T, quaternions.T, strict=True)
    tension = np.array([loads(place, quaternion)[2][0] for place, quaternion in pairs])
    curves: dict[str, np.ndarray] = {"surge": path.y[0], "heave": path.y[2], "tension": tension}
    for name, values in curves.items():
        rows = [f"{t:.3f},{value:.9f}\n" for t, value in np.column_stack([path.t, values])]
        unit = "N" if name == "tension" else "m"
        file = Path(__file__).with_name(f"{name}.csv")
        file.write_text(f"t [s],{name} [{unit}]\n" + "".join(rows))


if __name__ == "__main__":
    main()
