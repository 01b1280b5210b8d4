"""Limits of the coupling of cube and water: ``python scenarios/floating_cube/window_limit.py``.

The water's own response, linear: a cube too heavy to be stopped is pushed down at 1 mm/s, and the
force less that on a cube at rest is g(t) [N s/m] per velocity. A cube of mass m whose acceleration
a_n is constant in windows w feels mean forces -Σ H_k a_{n-k}, H the second differences over w of
∫∫ g dt dt at multiples of w.

Repeated windows (Causin, Gerbeau & Nobile, Comput. Methods Appl. Mech. Engrg. 194 (2005) 4506): a
guess comes back times -H_0/m; a share ω of the residual converges up to ω = 2 / (1 + H_0/m).

Staggered windows: m a_n = -Σ H_k a_{n-1-k}. The same of the window before is subtracted, so that
g(t) ends as a constant and not at once: stable if no root of z^n - z^{n-1} + Σ (H_k - H_{k-1})/m
z^{n-1-k} is outside of the circle of 1. In short windows g(t) lags, which is unstable for light
cubes however short the window; long ones come to H_0 = M, the added mass, and M < m.
"""

import tempfile
from pathlib import Path

import numpy as np

from quintet.coupler.files.recording import Recording
from quintet.coupler.run.run_scene import run_scene
from quintet.coupler.scene.read import load
from quintet.interfaces.component import Array

EDGE, SPEED = 0.15, 1e-3  # m, m/s
WINDOW, END = 5e-4, 0.12  # s, of the runs
ROUNDING = 1e-9  # of roots
SETTINGS = (
    "expect=[]",
    f"end={END}",
    f"window={WINDOW}",
    "components.water.spacing=0.03",
    "components.cube.gravity=[0.0, 0.0, 0.0]",
    "components.cube.bodies.0.density=1e7",
    'output.fields=["water.surface_load.force"]',
    "output.interval=0",
    "output.pictures=[]",
)


def impulse(speed: float) -> Array:
    """Impulse [N s] of the water on a cube that sinks at a speed [m/s], in each window."""
    velocity = f"components.cube.bodies.0.velocity=[0.0, 0.0, {-speed}]"
    with tempfile.TemporaryDirectory() as folder:
        scene = load("floating_cube", settings=(*SETTINGS, velocity), transport="memory")
        path, _ = run_scene(scene, Path(folder) / "run")
        with Recording(path) as recording:
            count = len(recording.times("water"))
            force = recording.field("water", "surface_load.force", slice(0, count))
    return np.asarray(force)[1:, :, 2].sum(axis=1)


def response() -> tuple[Array, Array]:
    """Times [s], and ∫∫ g dt dt [kg s] until then."""
    once = np.concatenate([[0.0], np.cumsum(impulse(SPEED) - impulse(0.0))]) / SPEED
    twice = np.concatenate([[0.0], np.cumsum(0.5 * (once[1:] + once[:-1]))]) * WINDOW
    return WINDOW * np.arange(len(twice)), twice


def masses(times: Array, twice: Array, window: float) -> Array:
    """H_k [kg]."""
    count = int(times[-1] / window)
    values = np.interp(window * np.arange(-1, count + 1), times, twice)
    values[0] = 0.0
    return np.asarray((values[2:] - 2.0 * values[1:-1] + values[:-2]) / window)


def growth(masses: Array, mass: float) -> float:
    """Largest factor in a staggered window of a cube [kg]."""
    changes = np.diff(masses, prepend=0.0) / mass
    return float(np.abs(np.roots([1.0, changes[0] - 1.0, *changes[1:]])).max())


def lightest(masses: Array) -> float:
    """Least density [kg/m3] of a cube that staggered windows hold, by bisection."""
    low, high = 10.0, 2000.0
    while high - low > 1.0:
        density = 0.5 * (low + high)
        if growth(masses, density * EDGE**3) > 1.0 + ROUNDING:
            low = density
        else:
            high = density
    return high


def main() -> None:
    """Print both limits."""
    times, twice = response()
    for window in (2e-3, 4e-3, 6e-3, 8e-3, 12e-3):
        shown = masses(times, twice, window)
        shares = [2.0 / (1.0 + shown[0] / (density * EDGE**3)) for density in (50.0, 100.0, 200.0)]
        print(f"{1e3 * window:.0f} ms: H_0 = {shown[0]:.3f} kg; relaxation of 50, 100, 200 kg/m3:")
        print("  " + ", ".join(f"{share:.2f}" for share in shares), end="; ")
        print(f"staggered windows hold cubes from {lightest(shown):.0f} kg/m3")
    rise = growth(masses(times, twice, WINDOW), 50.0 * EDGE**3) - 1.0
    print(f"{1e3 * WINDOW:g} ms: the motion of 50 kg/m3 grows by {rise:.0%} in a staggered window")


if __name__ == "__main__":
    main()
