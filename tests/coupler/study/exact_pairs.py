"""Toy components with exact steps, so that only the coupling between two of them errs.

Each step solves the component's equation exactly for constant inputs. An `Inert` component takes an
impulse and gives its motion; a `Driven` one takes that motion and gives its reaction.
"""

from functools import lru_cache

import numpy as np
from scipy.linalg import expm

from quintet.interfaces.component import Component, Port
from quintet.interfaces.params import NotNegative, Number, Positive, parameters
from quintet.interfaces.ports import FORCE, HEAT_FLOW, POSITION, TEMPERATURE, VELOCITY

LOAD, MOTION = Port("load", (FORCE,)), Port("motion", (POSITION, VELOCITY))
FOOT, FOOT_LOAD = Port("foot", (POSITION, VELOCITY)), Port("foot_load", (FORCE,))
HEAT, SURFACE = Port("heat", (HEAT_FLOW,)), Port("surface", (TEMPERATURE,))
OUTSIDE, LOSS = Port("outside", (TEMPERATURE,)), Port("loss", (HEAT_FLOW,))


def oscillate(position, velocity, frequency2, damping, force, dt):
    """Solve x'' = a - ω² x - 2 γ x' exactly over a step dt, for a constant a (1, 3) m/s²."""
    flow = flow_of(frequency2, damping, dt)
    state = np.concatenate([position, velocity, force])  # (3, 3)
    return np.split((flow[:, :, None] * state).sum(axis=1)[:2], 2)


@lru_cache(maxsize=64)
def flow_of(frequency2, damping, dt):
    """Matrix that leads from (x, x', a) to the same after dt."""
    matrix = np.array([[0.0, 1.0, 0.0], [-frequency2, -2.0 * damping, 1.0], [0.0, 0.0, 0.0]])
    return expm(matrix * dt)


class Stateful(Component):
    """Saves and loads the arrays that it names."""

    state: tuple[str, ...] = ()

    def stable_dt(self):
        return np.inf

    def save(self):
        return {name: np.array(getattr(self, name)) for name in self.state}

    def load(self, state):
        for name in self.state:
            setattr(self, name, np.array(state[name]))


class Carrier(Stateful):
    """A mass, on a spring with a damper where it has one, that is pushed."""

    takes, gives = (LOAD,), (MOTION,)
    state = ("position", "velocity", "push")

    @parameters
    class Params:
        mass: Positive  # kg
        stiffness: NotNegative = 0.0  # N/m
        damping: NotNegative = 0.0  # N s/m
        start: Number = 0.0  # m
        speed: Number = 0.0  # m/s

    def __init__(self, params):
        self.params = params
        self.position, self.velocity = _along_x(params.start), _along_x(params.speed)
        self.push = np.zeros((1, 3))  # N

    def take(self, fields):
        self.push = np.array(fields.get("load.force", self.push))

    def step(self, dt):
        p = self.params
        self.position, self.velocity = oscillate(
            self.position,
            self.velocity,
            p.stiffness / p.mass,
            0.5 * p.damping / p.mass,
            self.push / p.mass,
            dt,
        )

    def give(self, wanted):
        return {"motion.position": self.position.copy(), "motion.velocity": self.velocity.copy()}


class Rider(Stateful):
    """A mass on a spring and a damper whose foot rides on another body."""

    takes, gives = (FOOT,), (MOTION, FOOT_LOAD)
    state = ("position", "velocity", "foot", "foot_velocity", "force")

    @parameters
    class Params:
        mass: Positive  # kg
        stiffness: NotNegative = 0.0  # N/m
        damping: NotNegative = 0.0  # N s/m
        start: Number = 0.0  # m
        speed: Number = 0.0  # m/s

    def __init__(self, params):
        self.params = params
        self.position, self.velocity = _along_x(params.start), _along_x(params.speed)
        self.foot, self.foot_velocity, self.force = (np.zeros((1, 3)) for _ in range(3))

    def take(self, fields):
        self.foot = np.array(fields.get("foot.position", self.foot))
        self.foot_velocity = np.array(fields.get("foot.velocity", self.foot_velocity))

    def step(self, dt):
        p, old_velocity = self.params, self.velocity
        pull = (p.stiffness * self.foot + p.damping * self.foot_velocity) / p.mass
        self.position, self.velocity = oscillate(
            self.position, old_velocity, p.stiffness / p.mass, 0.5 * p.damping / p.mass, pull, dt
        )
        self.force = -p.mass * (self.velocity - old_velocity) / dt

    def give(self, wanted):
        fields = {"motion.position": self.position, "motion.velocity": self.velocity}
        fields["foot_load.force"] = self.force
        return {key: fields[key].copy() for key in wanted}


class Swimmer(Rider):
    """A particle that a stream drags along: quadratically in their difference of velocities."""

    @parameters
    class Params:
        mass: Positive  # kg
        drag: Positive  # kg/m, of the difference of velocities squared
        start: Number = 0.0  # m
        speed: Number = 0.0  # m/s

    def step(self, dt):
        p, old_velocity = self.params, self.velocity
        slip = old_velocity - self.foot_velocity
        rate = p.drag / p.mass * np.abs(slip)  # 1/s
        self.velocity = self.foot_velocity + slip / (1.0 + rate * dt)
        slip_time = np.where(rate > 0.0, np.log1p(rate * dt) / np.where(rate > 0.0, rate, 1.0), dt)
        self.position = self.position + self.foot_velocity * dt + slip * slip_time
        self.force = -p.mass * (self.velocity - old_velocity) / dt


class Store(Stateful):
    """A body of one temperature that takes heat and leaks some of it to surroundings at 0 K."""

    takes, gives = (HEAT,), (SURFACE,)
    state = ("temperature", "heat")

    @parameters
    class Params:
        capacity: Positive  # J/K
        loss: NotNegative = 0.0  # W/K
        start: Number  # K

    def __init__(self, params):
        self.params, self.temperature = params, np.array([params.start])
        self.heat = np.zeros(1)

    def take(self, fields):
        self.heat = np.array(fields.get("heat.heat_flow", self.heat))

    def step(self, dt):
        p = self.params
        self.temperature = relax(self.temperature, self.heat / p.capacity, p.loss / p.capacity, dt)

    def give(self, wanted):
        return {"surface.temperature": self.temperature.copy()}


class Cooler(Stateful):
    """A body that exchanges heat with another body, whose temperature it takes."""

    takes, gives = (OUTSIDE,), (SURFACE, LOSS)
    state = ("temperature", "outside", "heat")

    @parameters
    class Params:
        capacity: Positive  # J/K
        conductance: Positive  # W/K, to the other body
        loss: NotNegative = 0.0  # W/K, to surroundings at 0 K
        start: Number  # K

    def __init__(self, params):
        self.params, self.temperature = params, np.array([params.start])
        self.outside, self.heat = np.zeros(1), np.zeros(1)

    def take(self, fields):
        self.outside = np.array(fields.get("outside.temperature", self.outside))

    def step(self, dt):
        p, old_temperature = self.params, self.temperature
        rate = (p.conductance + p.loss) / p.capacity
        source = p.conductance * self.outside / p.capacity
        self.temperature = relax(old_temperature, source, rate, dt)
        mean = source / rate + (old_temperature - source / rate) * -np.expm1(-rate * dt) / (
            rate * dt
        )
        self.heat = p.conductance * (mean - self.outside)

    def give(self, wanted):
        fields = {"surface.temperature": self.temperature, "loss.heat_flow": self.heat}
        return {key: fields[key].copy() for key in wanted}


def relax(value, source, rate, dt):
    """Solve x' = source - rate x exactly over a step dt, for a constant source."""
    if rate == 0.0:
        return value + dt * source
    return source / rate + (value - source / rate) * np.exp(-rate * dt)


def _along_x(number):
    return np.array([[number, 0.0, 0.0]])
