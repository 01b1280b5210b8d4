"""Rigid bodies on given paths: position and orientation as functions of time."""

import math

import numpy as np

from quintet.components.stand_ins.params import PrescribedParams, prescribed_ports
from quintet.interfaces.component import Array, Component, Fields

PUSHES = ("force", "torque")
SHAPES = {"sphere": 0.0, "box": 1.0}  # as ports.MOTION gives them


class Prescribed(Component):
    """Moves as told: x = x0 + v t + a sin(2 π f t), turning steadily about ω."""

    def __init__(self, params: PrescribedParams) -> None:
        self.takes, self.gives = prescribed_ports(params)
        self.held = {f"held.{key}": np.zeros((len(params.bodies), 3)) for key in PUSHES}
        bodies = params.bodies
        self.shape = np.array([SHAPES[one.shape] for one in bodies])
        self.size = np.array([one.size for one in bodies])  # (n, 3) m
        self.mass = np.array([one.mass for one in bodies])  # (n,) kg
        self.origin = np.array([one.position for one in bodies])  # (n, 3) m
        self.drift = np.array([one.velocity for one in bodies])  # (n, 3) m/s
        self.spin = np.array([one.angular_velocity for one in bodies])  # (n, 3) rad/s
        self.amplitude = np.array([one.amplitude for one in bodies])  # (n, 3) m
        self.pulsation = 2.0 * math.pi * np.array([[one.frequency] for one in bodies])  # rad/s
        self.time = 0.0  # s

    def describe(self) -> Fields:
        """State shapes, sizes and masses."""
        return {"motion.shape": self.shape, "motion.size": self.size, "motion.mass": self.mass}

    def stable_dt(self) -> float:
        """Allow any step: the path is known."""
        return math.inf

    def take(self, fields: Fields) -> None:
        """Keep what pushes, to give it again; nothing moves it."""
        for key in PUSHES:
            if f"load.{key}" in fields:
                self.held[f"held.{key}"] = np.array(fields[f"load.{key}"])

    def step(self, dt: float) -> None:
        """Let time pass."""
        self.time += dt

    def give(self) -> Fields:
        """Return the pose and its rate at the present time."""
        phase = self.pulsation * self.time
        moved = self.drift * self.time + self.amplitude * np.sin(phase)
        rate = self.drift + self.amplitude * self.pulsation * np.cos(phase)
        held = {key: value.copy() for key, value in self.held.items()} if self.takes else {}
        return {
            **held,
            "motion.position": self.origin + moved,
            "motion.velocity": rate,
            "motion.orientation": turned(self.spin, self.time),
            "motion.angular_velocity": self.spin.copy(),
        }

    def save(self) -> Fields:
        """Copy out the time and the loads."""
        return {"time": np.array([self.time])} | {k: v.copy() for k, v in self.held.items()}

    def load(self, state: Fields) -> None:
        """Come back to a time."""
        self.time = float(state["time"][0])
        self.held = {key: np.array(state[key]) for key in self.held}

    def items(self) -> int:
        """Count the bodies."""
        return len(self.mass)


def turned(spin: Array, time: float) -> Array:
    """Quaternions (n, 4) w, x, y, z after turning about spins (n, 3) rad/s for a time [s]."""
    rate = np.linalg.norm(spin, axis=1, keepdims=True)
    half = 0.5 * rate * time
    axis = spin / np.where(rate > 0.0, rate, 1.0)
    return np.concatenate([np.cos(half), axis * np.sin(half)], axis=1)
