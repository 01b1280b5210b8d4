"""Toys: two chains of masses and springs that can be glued to each other."""

import numpy as np

from quintet.components.shared.geometry.surface_samples_mesh import mesh_answer
from quintet.interfaces.component import Array, Component, Fields, Keys, Totals
from quintet.interfaces.params import Count, NotNegative, Number, Positive, parameters
from quintet.interfaces.ports import GLUED, GLUED_LOAD, NODE_GLUE, NODE_LOAD

X = np.array([1.0, 0.0, 0.0])
CORNERS = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])  # y, z of a unit square


def chain_masses(count: int, mass: float) -> Array:
    """Masses (count,) kg of a chain: half at its ends, as lumped finite elements have it."""
    masses = np.full(count, mass)
    masses[[0, -1]] *= 0.5
    return masses


def chain_force(u: Array, stiffness: float) -> Array:
    """Forces (rows, count) N of springs between neighbours, displaced by u (rows, count) m."""
    pull = stiffness * np.diff(u, axis=1)
    force = np.zeros_like(u)
    force[:, :-1] += pull
    force[:, 1:] -= pull
    return force


def hump(count: int, height: float) -> Array:
    """Displacement (count,) m of one smooth hump of twelve masses, about number eight."""
    place = np.clip((np.arange(count) - 8.0) / 6.0, -1.0, 1.0)
    return height * np.cos(0.5 * np.pi * place) ** 2 * (np.abs(place) < 1.0)


def chain_totals(mass: Array, u: Array, v: Array, stiffness: float) -> Totals:
    """Mass, momentum and energies of rows of masses."""
    kinetic = float(0.5 * (mass * v**2).sum())
    internal = float(0.5 * stiffness * (np.diff(u, axis=1) ** 2).sum())
    return Totals(float(mass.sum()), (mass * v).sum() * X, np.zeros(3), kinetic, 0.0, internal)


class Column(Component):
    """Layers of four masses with springs along x; the last layer is a face to be glued."""

    takes = (NODE_LOAD,)
    gives = (NODE_GLUE,)

    @parameters
    class Params:
        """One chain on every corner of a unit square."""

        layers: Count = 20
        mass: Positive = 1.0  # kg, of an inner mass
        stiffness: Positive = 1.0  # N/m
        height: Number = 0.0  # m, of a hump at the start
        dt: Positive = 0.1  # s

    def __init__(self, params: Params) -> None:
        self.params = params
        self.mass = np.tile(chain_masses(params.layers, params.mass), (4, 1))
        self.u = np.tile(hump(params.layers, params.height), (4, 1))  # (4, layers) m
        self.v = np.zeros_like(self.u)
        self.push = np.zeros((4 * params.layers, 3))  # N

    def describe(self) -> Fields:
        layers = self.params.layers
        place = np.repeat(np.arange(layers, dtype=float), 4)
        start = np.column_stack([place, np.tile(CORNERS, (layers, 1))])
        corner = np.arange(4 * layers - 4, 4 * layers, dtype=float)[None]
        return {"node_glue.start": start, "node_glue.corner": corner}

    def sample(self, request: Fields) -> Fields:
        return mesh_answer("node_glue", request, self.describe())

    def bind(self, static: Fields, joined: Keys) -> None:
        if "node_load" in joined:
            self.mass = self.mass + static["node_load.added_mass"].reshape(-1, 4).T

    def stable_dt(self) -> float:
        return self.params.dt

    def take(self, fields: Fields) -> None:
        self.push = np.array(fields.get("node_load.force", self.push))

    def step(self, dt: float) -> None:
        force = chain_force(self.u, self.params.stiffness) + self.push[:, 0].reshape(-1, 4).T
        self.v = self.v + dt * force / self.mass
        self.u = self.u + dt * self.v

    def give(self, wanted: Keys) -> Fields:
        return {key: self.v.T.reshape(-1, 1) * X for key in wanted}

    def save(self) -> Fields:
        return {"u": self.u.copy(), "v": self.v.copy(), "push": self.push.copy()}

    def load(self, state: Fields) -> None:
        self.u, self.v, self.push = (np.array(state[key]) for key in ("u", "v", "push"))

    def totals(self) -> Totals:
        return chain_totals(self.mass, self.u, self.v, self.params.stiffness)


class Rods(Component):
    """Rows of masses with springs along x; the first mass of each is glued to a mesh."""

    takes = (GLUED,)
    gives = (GLUED_LOAD,)

    @parameters
    class Params:
        """Rows side by side on the face at x = 19 m of a `Column`."""

        places: tuple[tuple[Number, Number], ...] = ((0.2, 0.2), (0.8, 0.2), (0.8, 0.8), (0.2, 0.8))
        count: Count = 20
        mass: Positive = 1.0  # kg, of an inner mass
        stiffness: Positive = 1.0  # N/m
        dt: Positive = 0.1  # s
        stiffer: tuple[tuple[Number, Number], ...] = ()  # from a time [s] on, dt times a factor
        hover: NotNegative = 0.0  # share by which dt swings from step to step

    def __init__(self, params: Params) -> None:
        self.params = params
        rows = len(params.places)
        self.mass = np.tile(chain_masses(params.count, params.mass), (rows, 1))
        self.u = np.zeros((rows, params.count))  # m
        self.v = np.zeros_like(self.u)
        self.pulled = np.zeros(rows)  # m/s, of the glued masses
        self.time, self.steps = 0.0, 0

    def describe(self) -> Fields:
        places = np.array(self.params.places)
        start = np.column_stack([np.full(len(places), 19.0), places])
        return {"glued_load.position": start, "glued_load.mass": self.mass[:, 0].copy()}

    def stable_dt(self) -> float:
        """As if the rods grew stiffer and back, and hovered about a limit."""
        factor = 1.0
        for time, scale in self.params.stiffer:
            factor = scale if self.time >= time else factor
        swing = 1.0 + self.params.hover * float(np.sin(2.39996 * self.steps))
        return self.params.dt * factor * swing

    def take(self, fields: Fields) -> None:
        if "glued.velocity" in fields:
            self.pulled = np.array(fields["glued.velocity"][:, 0])

    def step(self, dt: float) -> None:
        force = chain_force(self.u, self.params.stiffness)
        self.v = self.v + dt * force / self.mass
        self.v[:, 0] = self.pulled
        self.u = self.u + dt * self.v
        self.time, self.steps = self.time + dt, self.steps + 1

    def give(self, wanted: Keys) -> Fields:
        return {key: chain_force(self.u, self.params.stiffness)[:, :1] * X for key in wanted}

    def save(self) -> Fields:
        state = {"u": self.u.copy(), "v": self.v.copy(), "pulled": self.pulled.copy()}
        return {**state, "clock": np.array([self.time, self.steps])}

    def load(self, state: Fields) -> None:
        self.u, self.v, self.pulled = (np.array(state[key]) for key in ("u", "v", "pulled"))
        self.time, self.steps = float(state["clock"][0]), int(state["clock"][1])

    def totals(self) -> Totals:
        """Totals without the glued masses, which the mesh carries."""
        free_mass = self.mass.copy()
        free_mass[:, 0] = 0.0
        return chain_totals(free_mass, self.u, self.v, self.params.stiffness)
