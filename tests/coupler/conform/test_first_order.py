"""A component of first order in time keeps the law of half steps, with large impulses too."""

import numpy as np

from quintet.coupler.conform.check import try_all
from quintet.coupler.conform.laws import name_of, time_steps
from quintet.coupler.conform.trial import Trial
from quintet.interfaces.component import Component, Port
from quintet.interfaces.manifest import ConformCase, manifest_of
from quintet.interfaces.params import Positive, parameters
from quintet.interfaces.ports import FORCE, POSITION, VELOCITY

LAW = name_of(time_steps.two_half_steps_come_to_one)


class EulerSpring(Component):
    """A mass on a spring by the explicit Euler method; it gives the force on its mount."""

    takes = (Port("push", (FORCE,)),)
    gives = (Port("motion", (POSITION, VELOCITY)), Port("pull", (FORCE,)))

    @parameters
    class Params:
        stiffness: Positive = 1e6  # N/m

    def __init__(self, params):
        self.stiffness = params.stiffness
        self.x, self.v = np.array([[1.0, 0.0, 0.0]]), np.array([[0.0, 2.0, 0.0]])
        self.force = self.push = np.zeros((1, 3))

    def stable_dt(self):
        return 0.01

    def take(self, fields):
        self.push = np.array(fields.get("push.force", self.push))

    def step(self, dt):
        self.force = self.stiffness * self.x
        self.x, self.v = self.x + dt * self.v, self.v + dt * (self.push - self.force) / 1e6

    def give(self, wanted):
        fields = {"motion.position": self.x, "motion.velocity": self.v, "pull.force": self.force}
        return {key: fields[key].copy() for key in wanted}

    def save(self):
        return {"state": np.array([self.x, self.v, self.force, self.push])}

    def load(self, state):
        self.x, self.v, self.force, self.push = np.array(state["state"])

    @staticmethod
    def conform_cases():
        rest = {"push.force": np.zeros((1, 3))}
        return (ConformCase("a stiff spring", {}, dt=0.01, rest=rest, scale={"push.force": 1.0}),)


def test_explicit_euler_passes_where_impulses_are_large(tmp_path):
    manifest = manifest_of(EulerSpring, f"{__name__}:EulerSpring")
    (case,) = EulerSpring.conform_cases()
    findings = [finding for _, finding in try_all(Trial(manifest, case, tmp_path)) if finding]
    assert next(finding.status for finding in findings if finding.law == LAW) == "passed"
