"""Rigid bodies on given paths: position and orientation as functions of time."""

import math

import numpy as np

from quintet.components.stand_ins.params import (
    PrescribedBody,
    PrescribedParams,
    prescribed_ports,
)
from quintet.interfaces.component import Array, Component, Fields, Keys
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
        self.corners = [corners_of(one) for one in bodies]
        sizes = zip(bodies, self.corners, strict=True)
        self.size = np.array([size_of(one, corner) for one, corner in sizes])  # (n, 3) m
        self.mass = np.array([one.mass for one in bodies])  # (n,) kg
        self.origin = np.array([one.position for one in bodies])  # (n, 3) m
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


def corners_of(body: PrescribedBody) -> Array:
    """Corners (k, 2) m, x and z, of a polygon, going round from x to z; none of other shapes."""
    if body.corners is None:
        return NONE
    # Polygons are left out of scenes that have none.
    from quintet.components.shared.geometry.polygons import in_order

    return in_order(body.corners)


def size_of(body: PrescribedBody, corner: Array) -> Array:
    """Size (3,) m as `ports.MOTION` and `ports.PLANAR_MOTION` give it; corners (k, 2) m."""
    if body.size is None:
        x, z = np.ptp(corner, axis=0)
        return np.array([x, 1.0, z])
    x, y, z = body.size
    return np.array([x, 1.0 if body.shape == "disc" else y, z])


def steady_rotation(angular_velocity: Array, time: float) -> Array:
    """Quaternions (n, 4) w, x, y, z after rotation by ω (n, 3) rad/s for a time [s]."""
    rate = np.linalg.norm(angular_velocity, axis=1, keepdims=True)
    half = 0.5 * rate * time
    axis = angular_velocity / np.where(rate > 0.0, rate, 1.0)
    return np.concatenate([np.cos(half), axis * np.sin(half)], axis=1)
