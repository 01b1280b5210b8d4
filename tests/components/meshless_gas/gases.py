"""Small gases for tests."""

from typing import Any

from quintet.components.meshless_gas.component import MeshlessGas
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.component import ONE_THREAD, Array, Resources
from quintet.interfaces.params import read

GAMMA = 1.4
SOD = ((1.0, 0.0, 1.0), (0.125, 0.0, 0.1))


def state(density: float, speed: float, pressure: float) -> dict[str, Any]:
    return {"density": density, "velocity": [speed, 0.0, 0.0], "pressure": pressure}


def gas_in_box(resources: Resources = ONE_THREAD, **keys: Any) -> MeshlessGas:
    """A gas of gas constant 1 in a box of 1 m, with keys of a scene."""
    box = {"lowest": [0.0, 0.0, 0.0], "highest": [1.0, 1.0, 1.0], "spacing": 0.1, "jitter": 0.3}
    table = {"gas": {"gas_constant": 1.0}, **keys, "box": {**box, **keys.get("box", {})}}
    params, mistakes = read(MeshlessGasParams, table, "gas")
    assert not mistakes, mistakes
    return MeshlessGas(params, resources)


def tube(nodes: int, left: Any, right: Any, **keys: Any) -> MeshlessGas:
    """A shock tube of 1 m, its diaphragm in the middle."""
    spacing = 1.0 / (nodes - 1)
    sides = [state(*side) for side in (left, right)]
    box = {"highest": [1.0, 0.0, 6.0 * spacing], "spacing": spacing}
    return gas_in_box(
        box=box | keys.pop("box", {}),
        riemann={"position": 0.5, "left": sides[0], "right": sides[1]},
        boundaries={
            name: {"kind": "inflow", "state": side}
            for name, side in zip(("x-", "x+"), sides, strict=True)
        },
        **{"neighbours": 8, **keys},
    )


def run(gas: MeshlessGas, end: float) -> MeshlessGas:
    """Step a gas to a time [s]."""
    while gas.state.time < end * (1.0 - 1e-12):
        gas.step(min(gas.stable_dt(), end - gas.state.time))
    return gas


def output(gas: MeshlessGas, key: str) -> Array:
    """An output of a gas."""
    return gas.give(frozenset({key}))[key]
