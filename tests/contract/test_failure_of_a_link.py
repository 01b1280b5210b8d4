"""A component fails because its link is unstable: the fault names the unstable link."""

import json
import shutil
from pathlib import Path

import pytest

from quintet.coupler.cli import main
from quintet.coupler.scene.read import library

MASSES = '''
"""Masses that fail where a solver would."""

import numpy as np
from springs import Mass

from quintet.interfaces.errors import StepError


class Fragile(Mass):
    def step(self, dt):
        if np.abs(self.push).max() > 1e8:
            raise StepError("the load must be below 1e8 N")
        super().step(dt)


class Bounded(Mass):
    def step(self, dt):
        if self.position[0, 2] > 0.52:
            raise StepError("the mass must stay below 0.52 m")
        super().step(dt)
'''
# The stiffer spring answers within the window: in turn, its mass and the other drive each other.
STIFF = ("components.upper.stiffness=1e6", "components.lower.kind='fragile:Fragile'")


def fault(folder: Path, *settings: str) -> tuple[int, dict]:
    """Run the masses with a fragile one; return the exit status and the report of the fault."""
    source = library()["two_springs"]
    shutil.copytree(source.parent, folder / "springs")
    (folder / "springs" / "fragile.py").write_text(MASSES)
    options = [word for setting in settings for word in ("--set", setting)]
    scene, out = str(folder / "springs" / "scene.toml"), str(folder / "run")
    with pytest.raises(SystemExit) as error:
        main(["run", scene, "--transport", "memory", "--out", out, "--set", "expect=[]", *options])
    return error.value.code, json.loads((folder / "run" / "results.json").read_text())["fault"]


def test_a_failure_in_an_unstable_coupling_tells_that_it_is_unstable(tmp_path, capsys):
    status, failure = fault(tmp_path, "scheme='serial'", *STIFF)
    assert status == 3
    assert "the load must be below 1e8 N" in failure["cause"]
    text = failure["coupling"][0]
    assert text.startswith("the coupling of link spring seems unstable: ")
    assert 'set scheme = "iterated"' in text
    assert text in capsys.readouterr().err


def test_a_failure_in_a_stable_coupling_blames_no_link(tmp_path):
    status, failure = fault(tmp_path, "components.lower.kind='fragile:Bounded'")
    assert status == 3
    assert "the mass must stay below 0.52 m" in failure["cause"]
    assert "coupling" not in failure
