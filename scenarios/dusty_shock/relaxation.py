"""Behind a steady shock in a dusty gas: conservation laws and two equations of relaxation.

Gas and dust enter the shock at one velocity and temperature. The gas jumps, the dust does not; then
drag and heat bring them together, while mass, momentum and energy of both stay:

    ρ u = m,   m u + p + η m v = const,   m (c_p T + u²/2) + η m (c T_d + v²/2) = const,
    v dv/dx = 18 μ f(Re) (u - v)/(ρ_d d²),   v dT_d/dx = 6 λ Nu (T - T_d)/(ρ_d c d²)

Carrier, J. Fluid Mech. 4 (1958) 376; Miura & Glass, Proc. R. Soc. A 382 (1982) 373 (shock tube).
Drag by Clift & Gauvin and heat by Ranz & Marshall are written here, apart from the solver's.

Run as a program, ``python -m quintet.scenarios.dusty_shock.relaxation``, it writes `velocity.csv`
and `warmer.csv` (above its first temperature), what a grain of dust does after the shock has met
it, and prints what the scene is made of; with the folder of a run it draws `profile.png` there.
"""

import math
import sys
from dataclasses import dataclass
from pathlib import Path

import matplotlib
import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from quintet.coupler.files.recording import Recording
from quintet.interfaces.component import Array

matplotlib.use("Agg")
import matplotlib.pyplot as plt

GAMMA, GAS_CONSTANT, PRANDTL = 1.4, 287.05, 0.72
CP = GAMMA * GAS_CONSTANT / (GAMMA - 1.0)  # J/(kg K)
PRESSURE, TEMPERATURE = 1e5, 300.0  # Pa, K, of the dusty gas at rest
DENSITY = PRESSURE / (GAS_CONSTANT * TEMPERATURE)
SOUND = math.sqrt(GAMMA * GAS_CONSTANT * TEMPERATURE)  # m/s
SIZE, MATERIAL, CAPACITY = 1e-5, 2500.0, 766.0  # m, kg/m3, J/(kg K): crown glass
LOADING = 0.5  # mass of dust over that of gas
MACH, MET = 1.6, 100.0  # 1, m/s: a grain that is as fast has met the shock


def viscosity(temperature: float) -> float:
    """Dynamic viscosity [Pa s] by Sutherland."""
    return 1.78e-5 * (temperature / 273.15) ** 1.5 * (273.15 + 110.4) / (temperature + 110.4)


@dataclass(frozen=True)
class Shock:
    """A steady shock, in its own frame; arrays are over time since a grain was met."""

    speed: float  # m/s, into the gas at rest
    time: np.ndarray  # (n,) s
    behind: np.ndarray  # (n,) m
    velocity: np.ndarray  # (n,) m/s, of the grain; where the gas was at rest the grain is too
    temperature: np.ndarray  # (n,) K, of the grain
    gas: np.ndarray  # (n, 3) m/s, K, Pa where the grain is; velocity in the laboratory


def gas_with(dust: float, heat: float, speed: float) -> tuple[float, float, float]:
    """Velocity [m/s] in the shock's frame, temperature [K] and pressure [Pa] of the gas.

    Of the subsonic state that momentum and energy leave it where dust has a velocity and a
    temperature.
    """
    flux = DENSITY * speed
    push = flux * speed + PRESSURE + LOADING * flux * (speed - dust)  # m u + p
    energy = CP * TEMPERATURE + 0.5 * speed**2
    energy += LOADING * (CAPACITY * (TEMPERATURE - heat) + 0.5 * (speed**2 - dust**2))
    # p = ρ R T, T = (energy - u²/2)/cp:  (γ+1)/(2γ) u² - push/m u + (γ-1)/γ energy = 0
    a, b, c = (GAMMA + 1.0) / (2.0 * GAMMA), push / flux, (GAMMA - 1.0) / GAMMA * energy
    u = (b - math.sqrt(b * b - 4.0 * a * c)) / (2.0 * a)
    return u, (energy - 0.5 * u * u) / CP, push - flux * u


def relax(speed: float, end: float, count: int = 400) -> Shock:
    """Follow a grain for a time [s] after the shock."""

    def rates(_: float, state: np.ndarray) -> list[float]:
        _, v, heat = state
        u, warm, pressure = gas_with(v, heat, speed)
        density, mu = pressure / (GAS_CONSTANT * warm), viscosity(warm)
        reynolds = density * abs(u - v) * SIZE / mu
        drag = 1.0 + 0.15 * reynolds**0.687
        drag += 0.0175 * reynolds / (1.0 + 42500.0 * max(reynolds, 1e-12) ** -1.16)
        pull = 18.0 * mu / (MATERIAL * SIZE**2) * drag * (u - v)
        nusselt = 2.0 + 0.6 * math.sqrt(reynolds) * PRANDTL ** (1.0 / 3.0)
        gain = 6.0 * nusselt * mu * CP / PRANDTL / (MATERIAL * CAPACITY * SIZE**2) * (warm - heat)
        return [v, pull, gain]

    time = end * np.linspace(0.0, 1.0, count) ** 2
    start = [0.0, speed, TEMPERATURE]
    path = solve_ivp(rates, (0.0, end), start, t_eval=time, method="LSODA", rtol=1e-9, atol=1e-9)
    behind, v, heat = path.y
    gas = np.array([gas_with(*pair, speed) for pair in zip(v, heat, strict=True)])
    gas[:, 0] = speed - gas[:, 0]
    return Shock(speed, time, behind, speed - v, heat, gas)


def equilibrium(speed: float) -> tuple[float, float, float]:
    """Velocity [m/s] in the laboratory, temperature [K] and pressure [Pa] far behind."""

    def lack(v: float) -> float:
        # With the dust as fast as the gas its temperature follows from that of the gas.
        return gas_with(v, warmth(v), speed)[0] - v

    def warmth(v: float) -> float:
        return brentq(lambda heat: gas_with(v, heat, speed)[1] - heat, 200.0, 3000.0)

    v = brentq(lack, 0.2 * speed, 0.8 * speed)
    u, warm, pressure = gas_with(v, warmth(v), speed)
    return speed - u, warm, pressure


def front(position: Array, velocity: Array) -> float:
    """Place [m] of the shock: of where grains have a given speed, less how far behind that is."""
    order = np.argsort(position)
    x, v = position[order], velocity[order]
    last = int(np.flatnonzero(v > MET)[-1])
    place = x[last] + (v[last] - MET) / (v[last] - v[last + 1]) * (x[last + 1] - x[last])
    exact = relax(MACH * SOUND, 1e-3)
    return float(place + np.interp(MET, exact.velocity, exact.behind))


def draw(run: str) -> None:
    """Draw gas and dust behind the shock at the end of a run, with the exact relaxation."""
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


def main() -> None:
    """Write the curves of a grain, and print what the scene needs."""
    speed = MACH * SOUND
    shock = relax(speed, 6e-3)
    folder = Path(__file__).parent
    warmer = shock.temperature - TEMPERATURE
    for name, curve in (("velocity", shock.velocity), ("warmer", warmer)):
        table = np.stack([shock.time, curve], -1)
        np.savetxt(folder / f"{name}.csv", table, "%.9g", ",", header=f"s,{name}", comments="")
    velocity, warm, pressure = equilibrium(speed)
    print(f"shock {speed:.4f} m/s; far behind {velocity:.4f} m/s, {warm:.4f} K, {pressure:.1f} Pa")
    mass = MATERIAL * math.pi / 6.0 * SIZE**3
    print(f"grains in a cubic metre: {LOADING * DENSITY / mass:.6g}")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        draw(sys.argv[1])
    else:
        main()
