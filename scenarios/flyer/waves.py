"""One-dimensional finite differences of a flyer: ``python -m quintet.scenarios.flyer.waves``.

A reference that shares no line with the solvers: cells of a Lagrangian mesh, velocities between
them, half a step apart (von Neumann & Richtmyer, J. Appl. Phys. 21 (1950) 232; Wilkins, Methods in
Computational Physics 3 (1964) 211). Prints for three meshes the velocity that the free surface
has reached, how far it is pulled back, and where the target fails; or draws, with `--draw`, free
surfaces of runs of this scene of aluminium beside it, into `surface.png` in the first one's folder.
"""

import argparse
import tomllib
from pathlib import Path
from typing import NamedTuple

import matplotlib
import numpy as np

from quintet.coupler.files.recording import Recording
from quintet.interfaces.component import Array

matplotlib.use("Agg")
import matplotlib.pyplot as plt


class Metal(NamedTuple):
    """Numbers of a metal, as Dyanov, Kazantsev and Chelakov give them in tables 2 to 5."""

    density: float  # kg/m3
    shear: float  # Pa
    a: float  # Pa, of Johnson and Cook's flow stress
    b: float  # Pa
    n: float
    c: float
    melting: float  # K
    sound: float  # m/s, c of U = c + S u
    slope: float  # S
    gamma: float
    spall: float  # Pa
    heat: float  # J/(kg K)


METALS = {
    "aluminium": Metal(2780.0, 27.6e9, 330e6, 426e6, 0.34, 0.015, 910.0, 5328.0, 1.338, 2.0, 1.1e9,
                       875.0),
    "steel": Metal(7850.0, 81.8e9, 350e6, 275e6, 0.36, 0.022, 1811.0, 4596.0, 1.49, 2.17, 2.25e9,
                   452.0),
}  # fmt: skip
ROOM = 298.0  # K
COURANT, LINEAR, QUADRATIC = 0.35, 0.1, 2.0  # share of a cell; coefficients of the viscosity


class Found(NamedTuple):
    """What a computation gives."""

    time: Array  # (steps,) s
    surface: Array  # (steps,) m/s, velocity of the free surface
    failed: Array  # (target's cells,) bool
    cell: float  # m


def pressure_at_rest(eta: Array, metal: Metal) -> Array:
    """Pressure [Pa] without energy, at η = 1 - ρ₀/ρ; linear in ρ where it is stretched."""
    stiff = metal.density * metal.sound**2
    squeezed = eta / (1.0 - metal.slope * eta) ** 2 * (1.0 - 0.5 * metal.gamma * eta)
    return np.asarray(stiff * np.where(eta > 0.0, squeezed, eta / (1.0 - eta)))


def isentrope(metal: Metal) -> tuple[Array, Array]:
    """Energy [J/kg] on the isentrope through rest, at places η."""
    eta = np.linspace(-0.3, 0.6, 9001)
    middle = 0.5 * (eta[1:] + eta[:-1])
    step, half = eta[1] - eta[0], metal.gamma * (eta[1] - eta[0]) / 2.0
    push = step * pressure_at_rest(middle, metal) / metal.density
    energy = np.zeros_like(eta)
    rest = int(np.argmin(np.abs(eta)))
    for k in range(rest, len(eta) - 1):
        energy[k + 1] = ((1.0 + half) * energy[k] + push[k]) / (1.0 - half)
    for k in range(rest, 0, -1):
        energy[k - 1] = ((1.0 - half) * energy[k] - push[k - 1]) / (1.0 + half)
    return eta, energy


def plastic_strain(trial: Array, strain: Array, soft: Array, dt: float, metal: Metal) -> Array:
    """Plastic strain of a step, by halving: trial - 3GΔ is the flow stress at Δ."""
    low, high = np.zeros_like(trial), trial / (3.0 * metal.shear)
    for _ in range(36):
        middle = 0.5 * (low + high)
        rate = np.maximum(middle / dt, 1.0)
        flow = (metal.a + metal.b * (strain + middle) ** metal.n) * soft
        more = trial - 3.0 * metal.shear * middle > flow * (1.0 + metal.c * np.log(rate))
        low, high = np.where(more, middle, low), np.where(more, high, middle)
    return np.asarray(low)


def struck(
    metal: Metal, speed: float, flyer: float, target: float, end: float, cells: int
) -> Found:
    """Strike a target (thickness m) by a flyer (thickness m, speed m/s) of so many cells."""
    cell = flyer / cells
    count = cells + round(target / cell)
    mass = metal.density * cell
    node_mass = np.full(count + 1, mass)
    node_mass[[0, -1]] *= 0.5
    x = cell * (np.arange(count + 1) - cells)
    u = np.where(np.arange(count + 1) < cells, speed, 0.0)
    u[cells] = 0.5 * speed
    volume = np.full(count, 1.0 / metal.density)
    p, s, q, e, strain = (np.zeros(count) for _ in range(5))
    warm, failed = np.full(count, ROOM), np.zeros(count, bool)
    table = isentrope(metal)
    fast = np.sqrt(metal.sound**2 + 4.0 / 3.0 * metal.shear / metal.density)
    dt, time, times, surface = COURANT * cell / fast, 0.0, [], []
    while time < end:
        tension = np.concatenate([[0.0], s - p - q, [0.0]])
        u += dt * np.diff(tension) / node_mass
        x += dt * u
        length = np.diff(x)
        after = length / mass
        change = after - volume
        rate = 2.0 * np.diff(u) / (length + volume * mass)
        trial = np.where(failed, 0.0, s + 4.0 / 3.0 * metal.shear * rate * dt)
        soft = 1.0 - np.clip((warm - ROOM) / (metal.melting - ROOM), 0.0, 1.0)
        limit = (metal.a + metal.b * strain**metal.n) * soft
        mine = np.flatnonzero(1.5 * np.abs(trial) > limit)
        new = trial.copy()
        if len(mine):
            equivalent = 1.5 * np.abs(trial[mine])
            more = plastic_strain(equivalent, strain[mine], soft[mine], dt, metal)
            strain[mine] += more
            new[mine] *= 1.0 - 3.0 * metal.shear * more / equivalent
        eta = 1.0 - metal.density * after
        density = 1.0 / after
        squeeze = np.maximum(density / metal.density - 1.0, 0.0)
        sound = np.sqrt(
            metal.sound**2 * (1.0 + (4.0 * metal.slope - 1.0) * squeeze)
            + 4.0 / 3.0 * metal.shear / density
        )
        closing = length * np.maximum(-rate, 0.0)
        push = density * closing * (QUADRATIC * closing + LINEAR * sound)
        e += 0.25 * (s + new) * rate * dt * (volume + after)
        e -= 0.5 * (q + push + p) * change
        p = pressure_at_rest(eta, metal) + metal.gamma * metal.density * e
        p /= 1.0 + 0.5 * metal.gamma * metal.density * change
        failed |= new - p > metal.spall
        open_ = failed & (p < 0.0)
        p[open_], new[failed] = 0.0, 0.0
        e -= 0.5 * p * change
        s, q, volume = new, push, after
        warm = ROOM * np.exp(metal.gamma * eta) + (e - np.interp(eta, *table)) / metal.heat
        time += dt
        dt = min(
            1.05 * dt,
            COURANT * float((length / (sound * (1.0 + LINEAR) + 2.0 * QUADRATIC * closing)).min()),
        )
        times.append(time)
        surface.append(u[-1])
    return Found(np.array(times), np.array(surface), failed[cells:], cell)


def pulled_back(waves: Found, begin: float, end: float) -> tuple[float, float]:
    """Velocity [m/s] before the pull-back, the mean of a time [s], and least one after it."""
    before = (waves.time > begin) & (waves.time < end)
    return float(waves.surface[before].mean()), float(waves.surface[waves.time > end].min())


def draw(folders: list[str], cells: int) -> None:
    """Draw free surfaces of runs beside finite differences of so many cells in the flyer."""
    figure, axes = plt.subplots(1, len(folders), figsize=(5 * len(folders), 4), squeeze=False)
    for axis, folder in zip(axes[0], map(Path, folders), strict=True):
        flyer, target = tomllib.loads((folder / "scene.toml").read_text())["components"]["plates"][
            "bodies"
        ]
        thick = target["highest"][2]
        with Recording(folder) as recording:
            time = recording.times("plates")
            speed = recording.history("plates", "gauges.velocity", 0)[:, 2]
        metal = METALS["aluminium"]
        exact = struck(metal, flyer["velocity"][2], -flyer["lowest"][2], thick, time[-1], cells)
        axis.plot(1e6 * exact.time, exact.surface, "k-", label=f"finite differences, {cells} cells")
        axis.plot(1e6 * time, speed, "C1-", label="particles")
        arrival = 1e6 * float(exact.time[exact.surface > 100.0][0])
        axis.set(
            xlim=(arrival - 0.1, 1e6 * time[-1]), ylim=(500.0, 1050.0), xlabel="t [µs]",
            title=f"aluminium, target {1e3 * thick:.0f} mm",
        )  # fmt: skip
        axis.grid(alpha=0.3)
    axes[0, 0].set_ylabel("velocity of the free surface [m/s]")
    axes[0, 0].legend(loc="lower right")
    figure.tight_layout()
    figure.savefig(Path(folders[0]) / "surface.png", dpi=90)
    print(Path(folders[0]) / "surface.png")


def main() -> None:
    """Print what three meshes give, or draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--material", choices=METALS, default="aluminium")
    parser.add_argument("--fluid", action="store_true", help="without shear strength")
    parser.add_argument("--speed", type=float, default=1000.0, help="of the flyer, m/s")
    parser.add_argument("--flyer", type=float, default=2e-3, help="its thickness, m")
    parser.add_argument("--target", type=float, default=6e-3, help="its thickness, m")
    parser.add_argument("--plateau", type=float, nargs=2, default=(1.15e-6, 1.25e-6), help="s")
    parser.add_argument("--end", type=float, default=2.2e-6, help="s")
    parser.add_argument("--cells", type=int, nargs="+", default=(50, 100, 200), help="in the flyer")
    parser.add_argument("--draw", nargs="+", metavar="RUN", help="folders of runs to draw")
    options = parser.parse_args()
    if options.draw:
        draw(options.draw, max(options.cells))
        return
    metal = METALS[options.material]
    if options.fluid:
        metal = metal._replace(shear=1.0, a=1e-3, b=0.0)
    wave = np.sqrt(metal.sound**2 + 4.0 / 3.0 * metal.shear / metal.density)
    acoustic = metal.spall * (1.0 / metal.sound + 1.0 / wave) / metal.density
    print(f"s (1/c0 + 1/cL)/rho: {acoustic:.1f} m/s")
    for cells in options.cells:
        waves = struck(metal, options.speed, options.flyer, options.target, options.end, cells)
        high, low = pulled_back(waves, *options.plateau)
        torn = options.target - waves.cell * (np.flatnonzero(waves.failed) + 0.5)
        where = f"{1e3 * torn.min():.2f} to {1e3 * torn.max():.2f}" if len(torn) else "nowhere"
        print(
            f"{cells} cells: free surface {high:.1f} m/s, least {low:.1f} m/s, pulled back by "
            f"{high - low:.1f} m/s; failed {where} mm below the surface"
        )


if __name__ == "__main__":
    main()
