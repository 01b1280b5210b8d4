"""Break-up of the lattice: ``python -m quintet.scenarios.hot_bar_baths.escapes``.

A lattice of 16 points leaves its minimum of energy over saddles. Each is found from a point of the
hot half that is moved aside: uphill along the softest mode, downhill along all others. Over one
that leads back to the minimum the rate of escape is (Langer, Ann. Phys. 54 (1969) 258)

    λ/(2π) √(det K₀ / |det K|) exp(-E/kT)

with stiffnesses K₀ of the minimum and K of the saddle, its height E, and the growth rate λ of its
unstable mode, m λ² + C λ + K, with the friction C of the baths and of the collisions, half their
rate for each bond. T is the mean over the points, weighted by their shares in that mode; shares of
the bath's temperature are those of a run of 160 s. Half of all lattices have broken up when the
rates of all escapes times the time are ln 2.
"""

import itertools
import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.polynomial import polynomial
from scipy.optimize import brentq, minimize

from quintet.components.particle_dynamics.build import build
from quintet.components.particle_dynamics.coefficients import MIDDLE, SevenRoots
from quintet.components.particle_dynamics.params import ParticleLatticeParams
from quintet.components.shared.scene_limits import keys_of, scene_at_limit
from quintet.components.shared.search.nearest import nearest_rows
from quintet.coupler.files.recording import Recording
from quintet.coupler.run.run_scene import run_scene
from quintet.coupler.scene.read import load
from quintet.interfaces.component import Array
from quintet.interfaces.params import read

TIMES = (10.0, 40.0, 160.0)  # s
FIRST = (0.15, 0.3)  # spacings, by which points are moved at the start
LONGEST, CLIMB = 0.03, 0.02  # spacings: largest and uphill steps
SOFT = 1e-4  # of the highest eigenvalue: the least one that a step is divided by
STEPS = 150
RESIDUAL = 1e-10  # force over that of a spacing
SAME = 1e-3  # spacings between states that are the same


class Saddle(NamedTuple):
    """A saddle of energy that leads back to the minimum."""

    place: Array  # (n, 3) m
    height: float  # J
    attempts: float  # 1/s, the rate before exp(-E/kT)
    shares: Array  # (n,) of the points in the unstable mode


class Lattice:
    """Energy of a lattice with tethers, its slope and its stiffness."""

    def __init__(self, params: ParticleLatticeParams) -> None:
        built = build(params)
        assert isinstance(built.law, SevenRoots)
        self.law, self.start, self.mass = built.law, built.start, params.lattice.mass
        self.spacing, self.boltzmann = params.lattice.spacing, params.boltzmann
        count = len(self.start)
        self.i, self.j = np.triu_indices(count, 1)
        nearest = np.zeros((count, count))
        nearest[tuple(built.bonds.T)] = nearest[tuple(built.bonds.T[::-1])] = 1.0
        friction = 0.5 * params.collision_rate * (np.diag(nearest.sum(axis=1)) - nearest)
        self.tether = np.zeros(count)
        for bath in params.baths:
            rows = nearest_rows(self.start, [bath.lowest])
            self.tether[rows] = bath.tether
            friction[rows, rows] += bath.rate
        self.friction = np.kron(friction, np.eye(3))  # 1/s

    def energy(self, place: Array) -> float:
        """Energy [J] of points (n, 3) m."""
        length = np.linalg.norm(place[self.i] - place[self.j], axis=1)
        pairs = self._of_pairs(length, 0) * self.law.strength / self.law.per_metre
        moved = ((place - self.start) ** 2).sum(axis=1)
        return float(pairs.sum() + 0.5 * self.tether @ moved)

    def slope(self, place: Array) -> Array:
        """Derivative (n, 3) N of the energy."""
        arm = place[self.i] - place[self.j]
        length = np.linalg.norm(arm, axis=1)
        force = (self._of_pairs(length, 1) * self.law.strength / length)[:, None] * arm
        slope = self.tether[:, None] * (place - self.start)
        np.add.at(slope, self.i, force)
        np.add.at(slope, self.j, -force)
        return np.asarray(slope)

    def stiffness(self, place: Array) -> Array:
        """Second derivative (3 n, 3 n) N/m of the energy."""
        arm = place[self.i] - place[self.j]
        length = np.linalg.norm(arm, axis=1)
        along = self._of_pairs(length, 2) * self.law.strength * self.law.per_metre
        across = self._of_pairs(length, 1) * self.law.strength / length
        arm = arm / length[:, None]
        springs = (along - across)[:, None, None] * arm[:, :, None] * arm[:, None, :]
        springs += across[:, None, None] * np.eye(3)
        matrix = np.zeros((len(place), 3, len(place), 3))
        for i, j, spring in zip(self.i, self.j, springs, strict=True):
            matrix[i, :, i] += spring
            matrix[j, :, j] += spring
            matrix[i, :, j] -= spring
            matrix[j, :, i] -= spring
        tethers = np.diag(np.repeat(self.tether, 3))
        return np.asarray(matrix.reshape(place.size, place.size) + tethers)

    def _of_pairs(self, length: Array, order: int) -> Array:
        """Derivative of the pairs' energy, over the strength and in spacings."""
        x = length * self.law.per_metre
        inner, outer = (
            polynomial.polyval(x - MIDDLE, polynomial.polyder(series, order))
            for series in (self.law.inner, self.law.outer)
        )
        return np.where(x <= self.law.begin, inner, np.where(x < 2.0, outer, 0.0))


def climb(lattice: Lattice, place: Array, mode: Array) -> Array | None:
    """Follow a mode (3 n,) uphill to a saddle of one unstable mode, if there is one."""
    top = float(np.linalg.eigvalsh(lattice.stiffness(lattice.start))[-1])
    for _ in range(STEPS):
        slope = lattice.slope(place).ravel()
        values, modes = np.linalg.eigh(lattice.stiffness(place))
        if np.abs(slope).max() < RESIDUAL * top * lattice.spacing and values[0] < 0.0 < values[1]:
            return place
        k = 0 if values[0] < 0.0 else int(np.argmax(np.abs(modes.T @ mode)))
        mode = modes[:, k] if modes[:, k] @ mode > 0.0 else -modes[:, k]
        step = -(modes.T @ slope) / np.maximum(np.abs(values), SOFT * top)
        step[k] = -step[k]
        if values[k] > 0.0:
            step[k] = CLIMB * lattice.spacing * np.sign(modes[:, k] @ mode)
        way = modes @ step
        way *= min(1.0, LONGEST * lattice.spacing / np.abs(way).max())
        place = place + way.reshape(place.shape)
    return None


def leads_back(lattice: Lattice, place: Array) -> bool:
    """Whether one side of a saddle is the slope of the minimum at the start."""
    way = np.linalg.eigh(lattice.stiffness(place))[1][:, 0].reshape(place.shape)
    way *= 0.1 * LONGEST * lattice.spacing / np.abs(way).max()
    top = float(np.abs(lattice.stiffness(lattice.start)).max())  # N/m
    per_joule, per_newton = 1.0 / (top * lattice.spacing**2), 1.0 / (top * lattice.spacing)
    for sign in (1.0, -1.0):
        rest = minimize(
            lambda x: per_joule * lattice.energy(lattice.spacing * x.reshape(place.shape)),
            (place + sign * way).ravel() / lattice.spacing,
            jac=lambda x: (
                per_newton * lattice.slope(lattice.spacing * x.reshape(place.shape)).ravel()
            ),
            method="L-BFGS-B",
            options={"ftol": 0.0, "gtol": 1e-8},
        ).x.reshape(place.shape)
        if np.abs(rest - lattice.start / lattice.spacing).max() < 0.01:
            return True
    return False


def saddle_at(lattice: Lattice, place: Array) -> Saddle:
    """Height and rate of a saddle."""
    stiff, still = lattice.stiffness(place), lattice.stiffness(lattice.start)
    none = np.zeros_like(stiff)
    motion = np.block([[none, np.eye(len(stiff))], [-stiff / lattice.mass, -lattice.friction]])
    rates, modes = np.linalg.eig(motion)
    k = int(np.argmax(rates.real))
    squares = (modes[: place.size, k].real.reshape(place.shape) ** 2).sum(axis=1)
    ratio = np.linalg.slogdet(still)[1] - np.linalg.slogdet(stiff)[1]
    attempts = float(rates[k].real / (2.0 * np.pi) * np.exp(0.5 * ratio))
    height = lattice.energy(place) - lattice.energy(lattice.start)
    return Saddle(place, height, attempts, squares / squares.sum())


def saddles(lattice: Lattice) -> list[Saddle]:
    """Saddles next to the minimum that points of the hot half pass, each once."""
    middle = 0.5 * (lattice.start[:, 0].min() + lattice.start[:, 0].max())
    shifts = [shift for shift in itertools.product((-1.0, 0.0, 1.0), repeat=3) if any(shift)]
    places: list[Array] = []
    points = np.flatnonzero(lattice.start[:, 0] < middle)
    for point, shift, first in itertools.product(points, shifts, FIRST):
        mode = np.zeros_like(lattice.start)
        mode[point] = np.array(shift) / np.linalg.norm(shift)
        place = climb(lattice, lattice.start + first * lattice.spacing * mode, mode.ravel())
        if place is None or any(
            np.abs(place - known).max() < SAME * lattice.spacing for known in places
        ):
            continue
        places.append(place)
    return [saddle_at(lattice, place) for place in places if leads_back(lattice, place)]


def warmth(hot: float) -> Array:
    """Mean temperatures (n,) of the points of a run, over that of the hot bath [K]."""
    with tempfile.TemporaryDirectory() as folder:
        scene = load("hot_bar_baths", "points16", settings=("expect=[]", "output.pictures=[]"))
        path, _ = run_scene(scene, Path(folder) / "run")
        with Recording(path) as recording:
            return np.asarray(recording.field("bar", "points.temperature")[-1]) / hot


def break_up(lattice: Lattice, ways: list[Saddle], share: Array, time: float) -> float:
    """Temperature [K] of the hot bath at which half of all lattices break up in a time [s]."""
    heights = np.array([saddle.height / lattice.boltzmann for saddle in ways])
    attempts = np.array([saddle.attempts for saddle in ways])
    shares = np.array([saddle.shares @ share for saddle in ways])

    def excess(hot: float) -> float:
        rate = (attempts * np.exp(-heights / (shares * hot))).sum()
        return float(np.log(rate * time / np.log(2.0)))

    return float(brentq(excess, 500.0, 5e4))


def lattice_of_scene() -> tuple[Lattice, float]:
    """Lattice of the scene's limit, and the temperature [K] of its hot bath in other runs."""
    scene, _ = scene_at_limit(Path(__file__).with_name("scene.toml"))
    params, mistakes = read(ParticleLatticeParams, keys_of(scene, "particle_lattice"), "bar")
    assert params is not None, mistakes
    return Lattice(params), params.baths[0].temperature


def main() -> None:
    """Print the saddles that count, and the temperatures."""
    lattice, hot = lattice_of_scene()
    share = warmth(hot)
    ways = saddles(lattice)
    print(f"{len(ways)} saddles; temperatures over the bath's: {np.round(share, 2)}")
    hot = break_up(lattice, ways, share, TIMES[1])

    def rate(saddle: Saddle) -> float:
        over = saddle.height / lattice.boltzmann / (saddle.shares @ share * hot)
        return saddle.attempts * float(np.exp(-over))

    total = sum(map(rate, ways))
    for saddle in sorted(ways, key=rate, reverse=True)[:12]:
        print(
            f"point {saddle.shares.argmax()}: {saddle.height / lattice.boltzmann:.3g} K, "
            f"{saddle.attempts:.3g}/s, {saddle.shares @ share:.2f} of the bath's temperature, "
            f"{rate(saddle) / total:.0%} of the rate at {hot:.0f} K"
        )
    for time in TIMES:
        print(f"{time:g} s: {break_up(lattice, ways, share, time):.0f} K")


if __name__ == "__main__":
    main()
