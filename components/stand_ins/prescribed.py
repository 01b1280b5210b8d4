"""Rigid bodies on given paths: position and orientation as functions of time."""

import math

import numpy as np

from quintet.components.shared.geometry.planar_shapes import Disc, Polygon
from quintet.components.shared.geometry.shape_keys import shape_of
from quintet.components.shared.geometry.shapes import Box, Shape, Sphere
from quintet.components.stand_ins.params import PrescribedParams, prescribed_ports
from quintet.interfaces.component import Array, Component, Field, Fields, Keys
from quintet.interfaces.params import Vector
from quintet.interfaces.ports import MOTION, VELOCITY

LOADS = ("force", "torque")
POSES = frozenset(f"motion.{field.name}" for field in MOTION.fields)


class Prescribed(Component):
    """Bodies at x = x0 + v t + a sin(2 π f t) that rotate steadily by ω."""

    shows = (VELOCITY, Field("radius", (), "m"))

    def __init__(self, params: PrescribedParams) -> None:
        self.takes, self.gives = prescribed_ports(params)
        self.loads = {f"measured_load.{key}": np.zeros((len(params.bodies), 3)) for key in LOADS}
        bodies = params.bodies
        self.planar = params.planar
        self.shapes = shapes = [shape_of(body, "bodies") for body in bodies]
        self.mass = np.array([body.mass for body in bodies])  # (n,) kg
        self.origin = np.array([centre_of(shape) for shape in shapes])  # (n, 3) m
        self.velocity = np.array([body.velocity for body in bodies])  # (n, 3) m/s
        self.angular_velocity = np.array([body.angular_velocity for body in bodies])  # rad/s
        self.amplitude = np.array([body.amplitude for body in bodies])  # (n, 3) m
        frequency = np.array([[body.frequency] for body in bodies])  # (n, 1) 1/s
        self.angular_frequency = 2.0 * math.pi * frequency  # rad/s
        self.time = 0.0  # s

    def describe(self) -> Fields:
        """State masses, and whether there are two dimensions."""
        planar = {"motion.dimensions": np.array([2.0])} if self.planar else {}
        return {"motion.mass": self.mass.copy(), **planar}

    def sample(self, request: Fields) -> Fields:
        """Sample the surfaces of all bodies as a partner requests."""
        # Left out of scenes whose bodies nobody samples.
        from quintet.components.shared.geometry.surface_samples import rigid_answer, sampler_of

        return rigid_answer("motion", request, [sampler_of(shape) for shape in self.shapes])

    def stable_dt(self) -> float:
        """Allow any step: the path is known."""
        return math.inf

    def take(self, fields: Fields) -> None:
        """Keep the loads, to return them; they move nothing."""
        for key in LOADS:
            if f"load.{key}" in fields:
                self.loads[f"measured_load.{key}"] = np.array(fields[f"load.{key}"])

    def step(self, dt: float) -> None:
        """Advance the time."""
        self.time += dt

    def give(self, wanted: Keys) -> Fields:
        """Return the pose and its rate at the present time."""
        phase = self.angular_frequency * self.time
        moved = self.velocity * self.time + self.amplitude * np.sin(phase)
        rate = self.velocity + self.amplitude * self.angular_frequency * np.cos(phase)
        loads = {key: value.copy() for key, value in self.loads.items()} if self.takes else {}
        fields = {
            **loads,
            "motion.position": self.origin + moved,
            "motion.velocity": rate,
            "motion.orientation": steady_rotation(self.angular_velocity, self.time),
            "motion.angular_velocity": self.angular_velocity.copy(),
        }
        return {key: fields[key] for key in wanted}

    def save(self) -> Fields:
        """Copy out the time and the loads."""
        return {"time": np.array([self.time])} | {k: v.copy() for k, v in self.loads.items()}

    def load(self, state: Fields) -> None:
        """Restore a time, and the loads."""
        self.time = float(state["time"][0])
        self.loads = {key: np.array(state[key]) for key in self.loads}

    def view(self) -> Fields:
        """Corners and faces of boxes and polygons, centres and radii of spheres and discs."""
        # Left out of runs without pictures.
        from quintet.components.stand_ins.body_view import view

        return view(self.shapes, self.give(POSES))

    def items(self) -> int:
        """Count the bodies."""
        return len(self.mass)


def centre_of(shape: Shape) -> Vector:
    """Place [m] that moves on the path."""
    if isinstance(shape, Polygon):
        return shape.origin
    assert isinstance(shape, Box | Sphere | Disc)
    return shape.centre


def steady_rotation(angular_velocity: Array, time: float) -> Array:
    """Quaternions (n, 4) w, x, y, z after rotation by ω (n, 3) rad/s for a time [s]."""
    rate = np.linalg.norm(angular_velocity, axis=1, keepdims=True)
    half = 0.5 * rate * time
    axis = angular_velocity / np.where(rate > 0.0, rate, 1.0)
    return np.concatenate([np.cos(half), axis * np.sin(half)], axis=1)
