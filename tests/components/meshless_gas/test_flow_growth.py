"""Growth of disturbances of a whole flow, and the predictions in scenes."""

import tomllib
from pathlib import Path

import numpy as np
import pytest

from quintet.components.meshless_gas.analysis.flow_growth import growth, largest_courant
from quintet.components.meshless_gas.analysis.flow_limit import gas_of
from quintet.components.meshless_gas.analysis.von_neumann import block, limit
from quintet.components.meshless_gas.component import MeshlessGas
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.params import read

SCENES = Path(__file__).resolve().parents[3] / "scenarios"
SPEED = 1.3  # m/s; the speed of sound is 1 m/s


def stream() -> MeshlessGas:
    """An even stream of first order through a periodic lattice."""
    even = {"density": 1.0, "pressure": 1.0 / 1.4, "velocity": [SPEED, 0.0, 0.0]}
    keys = {
        "gas": {"gamma": 1.4, "gas_constant": 1.0 / 1.4},
        "neighbours": 8,
        "order": 1,
        "courant": 0.5,
        "initial": even,
        "box": {"lowest": [0.0, 0.0, 0.0], "highest": [0.7, 0.0, 0.7], "spacing": 0.1},
        "boundaries": {side: {"kind": "periodic"} for side in ("x-", "x+", "z-", "z+")},
    }
    params, mistakes = read(MeshlessGasParams, keys, "gas")
    assert not mistakes, mistakes
    return MeshlessGas(params)


def test_disturbances_of_an_even_stream_grow_beyond_the_limit_of_von_neumann() -> None:
    known = limit(block(), np.array([SPEED, 0.0, 1e-3]), slopes=0.0)
    gas = stream()
    saved = gas.save()
    assert growth(gas, 0.95 * known) < 1.01
    gas.load(saved)
    assert growth(gas, 1.05 * known) > 1.02


@pytest.mark.full
@pytest.mark.parametrize("scene", ["blunt_sphere", "wedge", "moving_sphere"])
def test_scenes_predict_what_the_growth_in_their_flow_says(scene: str) -> None:
    path = SCENES / scene / "scene.toml"
    gas, limit_of_scene = gas_of(path, "Courant number")
    while gas.state.time < 0.5 * limit_of_scene["end"]:
        gas.step(gas.stable_dt())
    (first, *_) = tomllib.loads(path.read_text())["stability"]
    assert largest_courant(gas) == pytest.approx(np.max(first["predicted"]), rel=0.02)
