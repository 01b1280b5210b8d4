"""Even dust and gas relax to each other: four equations in time.

    u' = -η (u - v)/τ,   v' = (u - v)/τ,   c T_d' = q,   c_v T' = η ((u - v)²/τ - q),
    τ = ρ_d d²/(18 μ(T)),   q = 12 λ(T) (T - T_d)/(ρ_d d²)

by the drag of Stokes and a Nusselt number of 2; a single grain, launched later, follows alone.

Run as a program, ``python -m quintet.scenarios.dust_in_stream.relaxation``, it writes the curves.
"""

from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

GAS_CONSTANT, GAMMA, PRANDTL = 287.05, 1.4, 0.72
SIZE, MATERIAL, CAPACITY = 1e-5, 2000.0, 900.0  # m, kg/m3, J/(kg K)
STREAM, COLD, HOT, LOADING = 100.0, 300.0, 400.0, 0.5  # m/s, K, K, 1
LAUNCH, END = 4.8e-4, 2e-3  # s


def viscosity(temperature: float) -> float:
    """Dynamic viscosity [Pa s] by Sutherland."""
    return 1.78e-5 * (temperature / 273.15) ** 1.5 * (273.15 + 110.4) / (temperature + 110.4)


def rates(time: float, state: np.ndarray) -> list[float]:
    """Of gas and dust, velocity and temperature each, and of the velocity of a single grain."""
    u, v, warm, heat, single = state
    mu, cv = viscosity(warm), GAS_CONSTANT / (GAMMA - 1.0)
    per = 18.0 * mu / (MATERIAL * SIZE**2)
    q = 12.0 * mu * GAMMA * cv / PRANDTL * (warm - heat) / (MATERIAL * SIZE**2)
    follow = per * (u - single) if time >= LAUNCH else 0.0
    heating = LOADING * (per * (u - v) ** 2 - q) / cv
    return [-LOADING * per * (u - v), per * (u - v), heating, q / CAPACITY, follow]


def main() -> None:
    """Write velocity and temperature of the dust, and the velocity of the single grain."""
    state, pieces = [STREAM, 0.0, COLD, HOT, 0.0], []
    for span in ((0.0, LAUNCH), (LAUNCH, END)):
        times = np.linspace(*span, 101)
        states = solve_ivp(rates, span, state, t_eval=times, rtol=1e-10, atol=1e-10).y
        pieces.append(np.vstack([times, states]))
        state = states[:, -1].tolist()
    rows = np.hstack([pieces[0], pieces[1][:, 1:]])
    folder = Path(__file__).parent
    for name, k, begin in (("velocity", 2, 0.0), ("temperature", 4, 0.0), ("launched", 5, LAUNCH)):
        shown = rows[:, rows[0] >= begin]
        table = np.stack([shown[0], shown[k]], -1)
        np.savetxt(folder / f"{name}.csv", table, "%.9g", ",", header=f"s,{name}", comments="")
    density = 1e5 / (GAS_CONSTANT * COLD)
    mass = MATERIAL * np.pi / 6.0 * SIZE**3
    print(f"τ = {MATERIAL * SIZE**2 / (18.0 * viscosity(COLD)):.6g} s")
    print(f"grains in a cubic metre: {LOADING * density / mass:.6g}")
    print(f"at the end {rows[1:, -1]}")


if __name__ == "__main__":
    main()
