"""Rigid bodies on given paths: position and orientation as functions of time."""

import math

import numpy as np

from quintet.components.shared.geometry.shape_keys import shape_of
from quintet.components.shared.geometry.shapes import Box, Disc, Polygon, Shape, Sphere
from quintet.components.stand_ins.params import (
    PrescribedParams,
    prescribed_ports,
)
from quintet.interfaces.component import Array, Component, Fields, Keys
from quintet.interfaces.params import Vector
from quintet.interfaces.ports import BOX, DISC, POLYGON, SPHERE

LOADS = ("force", "torque")
NONE = np.zeros((0, 2))
SHAPES = {"sphere": SPHERE, "box": BOX, "disc": DISC, "polygon": POLYGON}


class Prescribed(Component):
    """Bodies at x = x0 + v t + a sin(2 π f t) that rotate steadily by ω."""

    def __init__(self, params: PrescribedParams) -> None:
        self.takes, self.gives = prescribed_ports(params)
        self.loads = {f"measured_load.{key}": np.zeros((len(params.bodies), 3)) for key in LOADS}
        bodies = params.bodies
        self.planar = params.planar
        self.shape = np.array([float(SHAPES[one.shape]) for one in bodies])
        shapes = [shape_of(body, "bodies") for body in bodies]
        self.corners = [one.outline if isinstance(one, Polygon) else NONE for one in shapes]
        self.size = np.array([size_of(shape) for shape in shapes])  # (n, 3) m
        self.mass = np.array([one.mass for one in bodies])  # (n,) kg
        self.origin = np.array([centre_of(shape) for shape in shapes])  # (n, 3) m
        self.velocity = np.array([one.velocity for one in bodies])  # (n, 3) m/s
        self.angular_velocity = np.array([one.angular_velocity for one in bodies])  # (n, 3) rad/s
        self.amplitude = np.array([one.amplitude for one in bodies])  # (n, 3) m
        self.angular_frequency = (
            2.0 * math.pi * np.array([[one.frequency] for one in bodies])
        )  # rad/s
        self.time = 0.0  # s

    def describe(self) -> Fields:
        """State shapes, sizes and masses; in two dimensions corners."""
        told = {"shape": self.shape, "size": self.size, "mass": self.mass}
        if self.planar:
            told["dimensions"] = np.array([2.0])
            told["corners"] = np.array([float(len(one)) for one in self.corners])
            told["corner"] = np.insert(np.concatenate(self.corners), 1, 0.0, axis=1)
        return {f"motion.{name}": array.copy() for name, array in told.items()}

    def stable_dt(self) -> float:
        """Allow any step: the path is known."""
        return math.inf

    def take(self, fields: Fields) -> None:
        """Keep the loads, to give them again; nothing moves by them."""
        for key in LOADS:
            if f"load.{key}" in fields:
                self.loads[f"measured_load.{key}"] = np.array(fields[f"load.{key}"])

    def step(self, dt: float) -> None:
        """Let time pass."""
        self.time += dt

    def give(self, wanted: Keys) -> Fields:
        """Return the pose and its rate at the present time."""
        phase = self.angular_frequency * self.time
        moved = self.velocity * self.time + self.amplitude * np.sin(phase)
        rate = self.velocity + self.amplitude * self.angular_frequency * np.cos(phase)
        loads = {key: value.copy() for key, value in self.loads.items()} if self.takes else {}
        given = {
            **loads,
            "motion.position": self.origin + moved,
            "motion.velocity": rate,
            "motion.orientation": steady_rotation(self.angular_velocity, self.time),
            "motion.angular_velocity": self.angular_velocity.copy(),
        }
        return {key: given[key] for key in wanted}

    def save(self) -> Fields:
        """Copy out the time and the loads."""
        return {"time": np.array([self.time])} | {k: v.copy() for k, v in self.loads.items()}

    def load(self, state: Fields) -> None:
        """Come back to a time."""
        self.time = float(state["time"][0])
        self.loads = {key: np.array(state[key]) for key in self.loads}

    def items(self) -> int:
        """Count the bodies."""
        return len(self.mass)


def centre_of(shape: Shape) -> Vector:
    """Place [m] that moves on the path."""
    if isinstance(shape, Polygon):
        return shape.origin
    assert isinstance(shape, Box | Sphere | Disc)
    return shape.centre


def size_of(shape: Shape) -> Vector:
    """Size [m] as `ports.MOTION` and `ports.PLANAR_MOTION` give it."""
    if isinstance(shape, Polygon):
        x, z = np.ptp(shape.outline, axis=0).tolist()
        return x, 1.0, z
    if isinstance(shape, Box):
        return shape.size
    assert isinstance(shape, Sphere | Disc)
    diameter = 2.0 * shape.radius
    return diameter, 1.0 if isinstance(shape, Disc) else diameter, diameter


def steady_rotation(angular_velocity: Array, time: float) -> Array:
    """Quaternions (n, 4) w, x, y, z after rotation by ω (n, 3) rad/s for a time [s]."""
    rate = np.linalg.norm(angular_velocity, axis=1, keepdims=True)
    half = 0.5 * rate * time
    axis = angular_velocity / np.where(rate > 0.0, rate, 1.0)
    return np.concatenate([np.cos(half), axis * np.sin(half)], axis=1)
