"""Temperature of a bath at which a lattice of few points breaks up.

    python -m quintet.components.particle_dynamics.analysis.escapes SCENE.toml [NAME]

prints the saddles that count most, and the temperature for each time `end` of a scene's limit of
stability NAME (the first if none is named). Its first bath is the hot one, at the low end of x.

The lattice leaves its minimum of energy over saddles. Each is found by eigenvector following: a
point of the hot half is displaced, and the lattice moves uphill along the mode nearest to that
displacement, along the lowest one as soon as that is unstable, and downhill along all others. A
saddle counts if one side of it leads to the minimum and the other one to a lattice that has lost a
bond: one between nearest points that is not 0.8 to 1.2 spacings long. A run of the scene ends when
two are, which at such temperatures is soon. The rate of escape is (Langer, Ann. Phys. 54 (1969)
258)

    λ/(2π) √(det K₀ / |det K|) exp(-E/kT)

with stiffnesses K₀ of the minimum and K of the saddle, its height E, and the growth rate λ of its
unstable mode, (m λ² + C λ + K) v = 0, with the friction C of the baths and of the collisions, half
their rate for each bond. T is the mean over the points, weighted by their squared motion in that
mode; temperatures over that of the hot bath are those of a run with the bath of the scene. Half of
all lattices have lost a bond when the rates of all escapes times the time are ln 2.
"""

import itertools
import sys
import tomllib
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq, minimize

from quintet.components.particle_dynamics.analysis.lattice_energy import LatticeEnergy
from quintet.components.particle_dynamics.component import ParticleLattice
from quintet.components.particle_dynamics.params import ParticleLatticeParams
from quintet.components.shared.scene_limits import keys_of, scene_at_limit
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import read

DISPLACEMENTS = (0.15, 0.3)  # spacings, of a point at the start
LONGEST, CLIMB = 0.03, 0.02  # spacings: largest and uphill steps
SOFT = 1e-4  # of the highest eigenvalue: the least one that a step is divided by
STEPS = 150
RESIDUAL = 1e-10  # of the force that moves the stiffest mode by a spacing
SAME = 1e-3  # spacings between saddles that are the same
NEAR = 0.01  # spacings from the minimum, of a descent that ends there


class Saddle(NamedTuple):
    """A saddle of energy between the minimum and a lattice that has lost a bond."""

    position: Array  # (n, 3) m
    height: float  # J, above the minimum
    prefactor: float  # 1/s, the rate of escape before exp(-E/kT)
    weights: Array  # (n,) squared motion of the points in the unstable mode, 1 in all


def climb(lattice: LatticeEnergy, position: Array, mode: Array) -> Array | None:
    """Follow a mode (3 n,) uphill to a saddle with one unstable mode; None if there is none."""
    top = float(np.linalg.eigvalsh(lattice.stiffness(lattice.start))[-1])
    for _ in range(STEPS):
        gradient = lattice.gradient(position).ravel()
        values, modes = np.linalg.eigh(lattice.stiffness(position))
        small = RESIDUAL * top * lattice.spacing
        if np.abs(gradient).max() < small and values[0] < 0.0 < values[1]:
            return position
        k = 0 if values[0] < 0.0 else int(np.argmax(np.abs(modes.T @ mode)))
        mode = modes[:, k] if modes[:, k] @ mode > 0.0 else -modes[:, k]
        step = -(modes.T @ gradient) / np.maximum(np.abs(values), SOFT * top)
        step[k] = -step[k]
        if values[k] > 0.0:
            step[k] = CLIMB * lattice.spacing * np.sign(modes[:, k] @ mode)
        move = modes @ step
        move *= min(1.0, LONGEST * lattice.spacing / np.abs(move).max())
        position = position + move.reshape(position.shape)
    return None


def loses_a_bond(lattice: LatticeEnergy, position: Array) -> bool:
    """Whether a saddle leads from the minimum to a lattice with fewer bonds."""
    mode = np.linalg.eigh(lattice.stiffness(position))[1][:, 0].reshape(position.shape)
    move = 0.1 * LONGEST * lattice.spacing / np.abs(mode).max() * mode
    ends = [descend(lattice, position + move), descend(lattice, position - move)]
    is_minimum = [np.abs(end - lattice.start).max() < NEAR * lattice.spacing for end in ends]
    return any(is_minimum) and min(map(lattice.intact, ends)) < len(lattice.bonds)


def descend(lattice: LatticeEnergy, position: Array) -> Array:
    """Positions (n, 3) m of the minimum below some positions."""
    unit = LONGEST * lattice.spacing  # m; the first step that is tried is one of these
    top = float(np.abs(lattice.stiffness(lattice.start)).max())  # N/m
    answer = minimize(
        lambda x: lattice.energy(unit * x.reshape(position.shape)) / (top * unit**2),
        position.ravel() / unit,
        jac=lambda x: lattice.gradient(unit * x.reshape(position.shape)).ravel() / (top * unit),
        method="L-BFGS-B",
        options={"ftol": 0.0, "gtol": 1e-6},
    )
    return np.asarray(unit * answer.x.reshape(position.shape))


def saddle_at(lattice: LatticeEnergy, position: Array) -> Saddle:
    """Height, prefactor and unstable mode of a saddle."""
    stiffness, at_rest = lattice.stiffness(position), lattice.stiffness(lattice.start)
    motion = np.block(
        [
            [np.zeros_like(stiffness), np.eye(len(stiffness))],
            [-stiffness / lattice.mass, -lattice.friction],
        ]
    )
    rates, modes = np.linalg.eig(motion)
    k = int(np.argmax(rates.real))
    squares = (modes[: position.size, k].real.reshape(position.shape) ** 2).sum(axis=1)
    log_ratio = np.linalg.slogdet(at_rest)[1] - np.linalg.slogdet(stiffness)[1]
    prefactor = float(rates[k].real / (2.0 * np.pi) * np.exp(0.5 * log_ratio))
    height = lattice.energy(position) - lattice.energy(lattice.start)
    return Saddle(position, height, prefactor, squares / squares.sum())


def find_saddles(lattice: LatticeEnergy) -> list[Saddle]:
    """Saddles on the way out of the minimum that points of the hot half lead to, each once."""
    middle = 0.5 * (lattice.start[:, 0].min() + lattice.start[:, 0].max())
    points = np.flatnonzero(lattice.start[:, 0] < middle)
    shifts = [shift for shift in itertools.product((-1.0, 0.0, 1.0), repeat=3) if any(shift)]
    positions: list[Array] = []
    for point, shift, displacement in itertools.product(points, shifts, DISPLACEMENTS):
        mode = np.zeros_like(lattice.start)
        mode[point] = np.array(shift) / np.linalg.norm(shift)
        displaced = lattice.start + displacement * lattice.spacing * mode
        position = climb(lattice, displaced, mode.ravel())
        if position is None or any(
            np.abs(position - known).max() < SAME * lattice.spacing for known in positions
        ):
            continue
        positions.append(position)
    return [
        saddle_at(lattice, position) for position in positions if loses_a_bond(lattice, position)
    ]


def relative_temperatures(params: ParticleLatticeParams, end: float) -> Array:
    """Mean temperatures (n,) of the points in a run to a time [s], over that of the first bath."""
    component = ParticleLattice(params)
    while component.time < end:
        component.step(component.stable_dt())
    temperature = component.give(frozenset({"points.temperature"}))["points.temperature"]
    return np.asarray(temperature / params.baths[0].temperature)


def rates(lattice: LatticeEnergy, saddles: list[Saddle], relative: Array, hot: float) -> Array:
    """Rates of escape [1/s] over saddles with a hot bath [K]; `relative` (n,) of the points."""
    return np.array(
        [
            saddle.prefactor
            * np.exp(-saddle.height / lattice.boltzmann / (saddle.weights @ relative * hot))
            for saddle in saddles
        ]
    )


def median_temperature(
    lattice: LatticeEnergy, saddles: list[Saddle], relative: Array, time: float
) -> float:
    """Temperature [K] of the hot bath at which half of all lattices lose a bond in a time [s]."""

    def excess(hot: float) -> float:
        return float(np.log(rates(lattice, saddles, relative, hot).sum() * time / np.log(2.0)))

    return float(brentq(excess, 500.0, 5e4))


def lattice_of(path: Path, name: str = "") -> tuple[ParticleLatticeParams, list[float], float]:
    """Lattice of a scene's limit, the times [s] of the limit, and the end [s] of the scene."""
    scene, limit = scene_at_limit(path, name)
    params, mistakes = read(ParticleLatticeParams, keys_of(scene, "particle_lattice"), "lattice")
    if params is None:
        raise SceneError(mistakes[0])
    end = tomllib.loads(path.read_text("utf-8"))["end"]
    against = limit.get("against", {})
    times = against["values"] if against.get("parameter") == "end" else [limit["end"]]
    return params, times, end


def main(path: str, name: str = "") -> None:
    """Print the saddles that count most, and the temperatures."""
    params, times, end = lattice_of(Path(path), name)
    lattice, relative = LatticeEnergy(params), relative_temperatures(params, end)
    saddles = find_saddles(lattice)
    print(f"{len(saddles)} saddles; temperatures over the hot bath's: {np.round(relative, 2)}")
    predicted = [median_temperature(lattice, saddles, relative, time) for time in times]
    hot = predicted[len(predicted) // 2]
    shares = rates(lattice, saddles, relative, hot)
    shares /= shares.sum()
    for k in np.argsort(-shares)[:12]:
        height, weights = saddles[k].height / lattice.boltzmann, saddles[k].weights
        print(
            f"point {weights.argmax()}: {height:.3g} K, prefactor {saddles[k].prefactor:.3g}/s, "
            f"T {weights @ relative:.2f} of the bath's, {shares[k]:.0%} of the rate at {hot:.0f} K"
        )
    for time, temperature in zip(times, predicted, strict=True):
        print(f"{time:g} s: {temperature:.0f} K")


if __name__ == "__main__":
    main(*sys.argv[1:])
