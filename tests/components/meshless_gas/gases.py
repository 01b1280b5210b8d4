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


def gas(resources: Resources = ONE_THREAD, **given: Any) -> MeshlessGas:
    """A gas of gas constant 1 in a box of 1 m, with keys of a scene."""
    box = {"lowest": [0.0, 0.0, 0.0], "highest": [1.0, 1.0, 1.0], "spacing": 0.1, "jitter": 0.3}
    table = {"gas": {"gas_constant": 1.0}, **given, "box": {**box, **given.get("box", {})}}
    params, mistakes = read(MeshlessGasParams, table, "gas")
    assert not mistakes, mistakes
    return MeshlessGas(params, resources)


def tube(nodes: int, left: Any, right: Any, **given: Any) -> MeshlessGas:
    """A shock tube of 1 m, its diaphragm in the middle."""
    spacing = 1.0 / (nodes - 1)
    sides = [state(*one) for one in (left, right)]
    box = {"highest": [1.0, 0.0, 6.0 * spacing], "spacing": spacing}
    return gas(
        box=box | given.pop("box", {}),
        riemann={"position": 0.5, "left": sides[0], "right": sides[1]},
        boundaries={
            name: {"kind": "inflow", "state": one}
            for name, one in zip(("x-", "x+"), sides, strict=True)
        },
        **{"neighbours": 8, **given},
    )


def run(made: MeshlessGas, end: float) -> MeshlessGas:
    """Step it to a time [s]."""
    while made.state.time < end * (1.0 - 1e-12):
        made.step(min(made.stable_dt(), end - made.state.time))
    return made


def given(made: MeshlessGas, key: str) -> Array:
    """One of its outputs."""
    return made.give(frozenset({key}))[key]
