"""Changes that a component makes when it learns of its partners belong to the start of a run."""

import json

from spring_scene import command, write

FOLLOWER = '''
"""A point that is put beside its partner as a run begins, and drifts from there."""

import numpy as np

from quintet.interfaces.component import Component, Port
from quintet.interfaces.params import parameters
from quintet.interfaces.ports import POSITION


class Follower(Component):
    """Keeps the way to its partner for a reader."""

    @parameters
    class Params:
        drift: float = 1.0  # m/s

    takes = (Port("partner", (POSITION,)),)
    gives = (Port("motion", (POSITION,)),)

    def __init__(self, params):
        self.params = params
        self.position = np.zeros((1, 3))

    def prime(self, fields):
        self.position = fields["partner.position"] + 1.0

    def stable_dt(self):
        return 0.02

    def take(self, fields):
        pass

    def step(self, dt):
        self.position = self.position + dt * self.params.drift

    def give(self, wanted):
        return {"motion.position": self.position.copy()}

    def save(self):
        return {"position": self.position.copy()}

    def load(self, state):
        self.position = np.array(state["position"])
'''
MORE = """
[components.follower]
kind = "follower:Follower"
[[links]]
kind = "direct"
pairs = [["spring.motion", "follower.partner"]]
[[expect]]
name = "start of the follower"
component = "follower"
field = "motion.position"
axis = 0
measure = "at"
begin = 0.0
value = 2.0
within = 1e-12
unit = "m"
source = "put 1 m beside the spring's start"
"""


def test_outputs_are_taken_after_components_know_their_partners(tmp_path):
    (tmp_path / "follower.py").write_text(FOLLOWER)
    out = tmp_path / "run"
    assert command("run", write(tmp_path, MORE, within=0.1), "--out", out) == 0
    results = json.loads((out / "results.json").read_text())
    values = {row["name"]: row["value"] for row in results["expect"]}
    assert values["start of the follower"] == 2.0
