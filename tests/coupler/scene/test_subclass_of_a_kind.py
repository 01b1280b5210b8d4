"""A class of one's own, derived from a kind that comes with quintet, is a kind too."""

import sys
from pathlib import Path

import numpy as np
import pytest

import quintet
from quintet.interfaces.errors import SceneError

OWN = '''
"""Water that is stirred, and says how much it turns."""

import numpy as np

from quintet.components.sph_fluid.component import SphFluid
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.interfaces.component import Field, Port
from quintet.interfaces.params import Number, parameters

SPIN = Port("spin_gauge", (Field("angular_momentum", (3,), "N m s"),))
KEY = "spin_gauge.angular_momentum"


class Stirred(SphFluid):
    """A fluid that starts turning about the z axis."""

    @parameters
    class Params(SphFluidParams):
        """What a scene says of it."""

        stirring: Number = 0.0  # rad/s

    @classmethod
    def ports_of(cls, params):
        takes, gives = super().ports_of(params)
        return takes, (*gives, SPIN)

    def __init__(self, params, resources):
        super().__init__(params, resources)
        place, motion = self.state.position_density, self.state.velocity_pressure
        motion[: self.state.fluid, 0] = -params.stirring * place[: self.state.fluid, 1]
        motion[: self.state.fluid, 1] = params.stirring * place[: self.state.fluid, 0]

    def give(self, wanted):
        fields = dict(super().give(wanted - {KEY}))
        if KEY in wanted:
            fields[KEY] = self.totals().angular_momentum[np.newaxis]
        return fields
'''
SCENE = """
name = "stirred"
end = 2e-3
window = 1e-3
transport = "memory"
[components.water]
kind = "{name}:Stirred"
spacing = 0.05
sound_speed = 20.0
gravity = [0.0, 0.0, 0.0]
stirring = 0.5
fluid = [{{ lowest = [-0.1, -0.1, 0.0], highest = [0.1, 0.1, 0.2] }}]
gauges = {{ pressure_gauges = [[0.0, 0.0, 0.1]], level_gauges = [[0.0, 0.0]], motion_gauge = true }}
[output]
fields = ["water.pressure_gauge.pressure", "water.level_gauge.height", "water.motion_gauge.speed",
  "water.spin_gauge.angular_momentum"]
"""


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    name = "stirred_water_of_a_test"
    (tmp_path / f"{name}.py").write_text(OWN)
    path = tmp_path / "scene.toml"
    path.write_text(SCENE.format(name=name))
    return path


def test_a_fluid_of_ones_own_keeps_its_gauges_and_has_another(scene: Path, tmp_path: Path) -> None:
    run = quintet.run(str(scene), out=str(tmp_path / "run"))
    assert run.status == "done"
    speed = np.asarray(run.fields["water.motion_gauge.speed"])
    assert speed[0, 0] == pytest.approx(0.5 * np.hypot(0.075, 0.075))
    level = np.asarray(run.fields["water.level_gauge.height"])
    assert level[:, 0] == pytest.approx(0.2, abs=0.01)
    spin = np.asarray(run.fields["water.spin_gauge.angular_momentum"])[:, 0, 2]
    inertia = 8.0 * (0.025**2 + 0.075**2)  # kg m2, of the particles
    assert spin == pytest.approx(np.full(3, 0.5 * inertia), rel=1e-6)


def test_its_own_parameters_are_checked_and_its_plan_is_known(scene: Path) -> None:
    assert "64" in str(quintet.check(str(scene), imports=True))
    with pytest.raises(SceneError, match="stirring should be a valid number; found 'much'"):
        quintet.check(str(scene), imports=True, settings={"components.water.stirring": "much"})
    with pytest.raises(SceneError, match=r"components.water.spacing should be greater than 0"):
        quintet.check(str(scene), imports=True, settings={"components.water.spacing": -1.0})


THROWN = """
from quintet.components.{kind}.component import {cls}
from quintet.components.{kind}.params import {cls}Params
from quintet.interfaces.params import Number, parameters


class Thrown({cls}):
    \"\"\"Starts with a speed upwards.\"\"\"

    @parameters
    class Params({cls}Params):
        \"\"\"What a scene says of it.\"\"\"

        speed: Number = 0.0  # m/s

    def __init__(self, params, resources):
        super().__init__(params, resources)
        self.state.velocity[:, 2] = params.speed
"""
BODIES = """
name = "thrown"
end = 1e-3
window = 1e-3
transport = "memory"
[components.thrown]
kind = "{name}:Thrown"
speed = 2.0
gravity = [0.0, 0.0, 0.0]
materials.steel = {{ youngs_modulus = 2e11, poissons_ratio = 0.3, friction = 0, restitution = 1 }}
[[components.thrown.bodies]]
shape = "sphere"
centre = [0.0, 0.0, 0.0]
radius = 0.05
density = 7850.0
material = "steel"
[output]
fields = ["thrown.motion.position"]
"""
STRUCTURE = """
name = "thrown"
end = 1e-5
window = 1e-6
transport = "memory"
[components.thrown]
kind = "{name}:Thrown"
speed = 2.0
[[components.thrown.parts]]
lowest = [0.0, 0.0, 0.0]
highest = [0.1, 0.1, 0.1]
elements = [2, 2, 2]
material = "steel"
[[components.thrown.coupled_faces]]
lowest = [0.0, 0.0, 0.1]
highest = [0.1, 0.1, 0.1]
[output]
fields = ["thrown.faces.position"]
"""

SOLID = """
name = "thrown"
end = 1e-6
window = 1e-7
transport = "memory"
[components.thrown]
kind = "{name}:Thrown"
spacing = 0.01
speed = 2.0
[[components.thrown.bodies]]
lowest = [0.0, 0.0, 0.0]
highest = [0.04, 0.04, 0.04]
material = "steel"
[output]
fields = ["thrown.bodies.position"]
"""


@pytest.mark.parametrize(
    ("kind", "cls", "text", "key"),
    [
        ("dem_bodies", "DemBodies", BODIES, "thrown.motion.position"),
        ("fe_plate", "FePlate", STRUCTURE, "thrown.faces.position"),
        ("sph_solid", "SphSolid", SOLID, "thrown.bodies.position"),
    ],
)
def test_other_kinds_may_be_derived_from_alike(
    tmp_path: Path, kind: str, cls: str, text: str, key: str
) -> None:
    name = f"thrown_{kind}_of_a_test"
    (tmp_path / f"{name}.py").write_text(THROWN.format(kind=kind, cls=cls))
    path = tmp_path / "scene.toml"
    path.write_text(text.format(name=name))
    run = quintet.run(str(path), out=str(tmp_path / "run"))
    assert run.status == "done"
    place = np.asarray(run.fields[key])[..., 2]
    assert place[-1] - place[0] == pytest.approx(2.0 * run.scene["end"], rel=1e-9)
    sys.modules.pop(name)


def teardown_module() -> None:
    sys.modules.pop("stirred_water_of_a_test", None)
