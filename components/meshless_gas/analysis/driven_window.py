"""Longest window of a light sphere that a partner moves through gas at rest, by the gas's force.

    python -m quintet.components.meshless_gas.analysis.driven_window SCENE.toml DENSITY...

The gas of the scene's first limit of stability, without its partner, answers a sphere that begins
to move at once; DENSITY [kg/m3] is that of the sphere. With F_j [N s/m], the mean force by the
speed in the j-th window after such a step, exchanges once per window w have
v[n+1] = v[n] - w/m Σ_j (v[n-j] - v[n-j-1]) F_j.
"""

import sys
from pathlib import Path

import numpy as np

from quintet.components.meshless_gas.component import MeshlessGas
from quintet.components.meshless_gas.driven_bodies import complete
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.shared.scene_limits import keys_of, scene_at_limit
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import read

SPEED = 1e-2  # of the speed of sound, to which the sphere is set
CROSSINGS = 6.0  # radii over the speed of sound, after which no force is left
FINEST, COARSEST, COUNT = 0.05, 2.0, 200  # radii over the speed of sound: windows that are tried


def response(gas: MeshlessGas, radius: float, sound: float) -> tuple[Array, Array]:
    """Times (n,) s since the sphere began to move, and impulse (n,) N s over its speed [m/s]."""
    speed, place, rest = SPEED * sound, 0.0, 0.0
    times, impulses = [0.0], [0.0]
    for velocity in (0.0, speed):
        time = 0.0
        while time < (CROSSINGS if velocity else 0.1) * radius / sound:
            dt = gas.stable_dt()
            middle = np.array([[place + 0.5 * dt * velocity, 0.0, 0.0]])
            push = np.array([[velocity, 0.0, 0.0]])
            gas.take({"motion.position": middle, "motion.velocity": push})
            gas.step(dt)
            time, place = time + dt, place + dt * velocity
            force = float(gas.give(frozenset(["load.force"]))["load.force"][0, 0])
            if velocity:
                times.append(time)
                impulses.append(impulses[-1] + dt * (rest - force) / speed)
            rest = rest if velocity else force
    return np.array(times), np.array(impulses)


def growth(window: float, mass: float, times: Array, impulses: Array) -> float:
    """Factor per window [s] by which the velocity of a sphere of a mass [kg] grows."""
    ends = window * np.arange(int(times[-1] / window) + 1)
    forces = np.diff(np.interp(ends, times, impulses)) / window
    roots = np.roots(np.concatenate([[1.0], window / mass * forces]))
    return float(np.abs(roots).max(initial=0.0))


def longest_window(mass: float, times: Array, impulses: Array, crossing: float) -> float:
    """Shortest window [s] beyond which velocities grow; infinite if there is none."""
    for window in np.geomspace(FINEST * crossing, COARSEST * crossing, COUNT).tolist():
        if growth(window, mass, times, impulses) > 1.0:
            return float(window)
    return float("inf")


def driven_gas(path: Path) -> tuple[MeshlessGas, float]:
    """Make the gas of a scene's first limit, and its sphere's radius [m]."""
    scene, _ = scene_at_limit(path)
    sphere = scene["components"]["particle"]["spheres"][0]
    keys = keys_of(scene, "meshless_gas")
    radius = float(sphere["radius"])
    stated = {"motion.position": np.zeros((1, 3)), "motion.radius": np.array([radius])}
    params, mistakes = read(MeshlessGasParams, complete(keys, stated), "gas")
    if mistakes:
        raise SceneError(mistakes[0])
    return MeshlessGas(params), radius


def main(words: list[str]) -> None:
    """Print the windows."""
    gas, radius = driven_gas(Path(words[0]))
    density, pressure = gas.state.primitive[gas.motion.domain.inner[0]][[0, 4]]
    sound = float(np.sqrt(gas.params.gas.gamma * pressure / density))
    times, impulses = response(gas, radius, sound)
    volume = 4.0 / 3.0 * np.pi * radius**3
    print(f"impulse over that of the added mass: {impulses[-1] / (0.5 * density * volume):.3f}")
    for word in words[1:]:
        window = longest_window(float(word) * volume, times, impulses, radius / sound)
        print(f"{word} kg/m3: {window:.4g} s")


if __name__ == "__main__":
    main(sys.argv[1:])
