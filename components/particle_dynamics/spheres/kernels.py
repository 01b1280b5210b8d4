"""Flight of spheres over a step: symplectic stages, and a turn to fourth order."""

from numba import njit

from quintet.components.shared.numba_options import EXACT
from quintet.components.shared.rotations import rotated
from quintet.interfaces.component import Array


@njit(**EXACT)
def fly(
    dt: float, end: float, stages: Array, gravity: Array, launch: Array, flying: Array,
    start: Array, mass: Array, inertia: Array, tether: Array, force: Array, torque: Array,
    position: Array, velocity: Array, orientation: Array, spin: Array,
) -> None:  # fmt: skip
    """Advance spheres that have been launched; those launched within the step for its rest.

    Parameters
    ----------
    dt, end : float, s
        Length of the step, and when it ends.
    stages : (s,) float array
        Shares of the step: 1, or Yoshida's three.
    gravity : (3,) float array, m/s2
    launch, flying : (n,) float array, s, and (n,) bool array
        When each is launched; whether it was before the step.
    start : (n, 3) float array, m
        To which tethers pull.
    mass, inertia, tether : (n,) float array, kg, kg m2, N/m
    force, torque : (n, 3) float array, N and N m
        Constant over the step.
    position, velocity, orientation, spin : (n, 3 or 4) float array, m, m/s, 1, rad/s
        Written. Angular velocities change linearly in time, for which the rotation vector
        ∫ω dt + dt³/12 (dω/dt × ω) is of fourth order.

    References
    ----------
    Yoshida, Phys. Lett. A 150 (1990) 262 (stages). Iserles et al., Acta Numer. 9 (2000) 215 (the
    second term of Magnus's series).
    """
    for i in range(position.shape[0]):
        span = dt if flying[i] else min(max(end - launch[i], 0.0), dt)
        if launch[i] > end:
            continue
        square = tether[i] / mass[i]  # 1/s2
        for stage in stages:
            h = stage * span
            for k in range(3):
                pushed = force[i, k] / mass[i] + gravity[k]
                velocity[i, k] += 0.5 * h * (pushed - square * (position[i, k] - start[i, k]))
                position[i, k] += h * velocity[i, k]
                velocity[i, k] += 0.5 * h * (pushed - square * (position[i, k] - start[i, k]))
        ax, ay, az = torque[i, 0] / inertia[i], torque[i, 1] / inertia[i], torque[i, 2] / inertia[i]
        ox, oy, oz = spin[i, 0], spin[i, 1], spin[i, 2]
        half, cubic = 0.5 * span * span, span**3 / 12.0
        x = span * ox + half * ax + cubic * (ay * oz - az * oy)
        y = span * oy + half * ay + cubic * (az * ox - ax * oz)
        z = span * oz + half * az + cubic * (ax * oy - ay * ox)
        q = (orientation[i, 0], orientation[i, 1], orientation[i, 2], orientation[i, 3])
        orientation[i, 0], orientation[i, 1], orientation[i, 2], orientation[i, 3] = rotated(
            q, x, y, z
        )
        spin[i, 0], spin[i, 1], spin[i, 2] = ox + span * ax, oy + span * ay, oz + span * az
