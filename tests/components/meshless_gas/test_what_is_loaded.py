"""A scene loads what it needs: friction only where the gas has it."""

import subprocess
import sys

STREAM = "{'density': 1.0, 'pressure': 0.7, 'velocity': (2.0, 0.0, 0.0)}"
CODE = f"""
import sys
from quintet.components.meshless_gas.component import MeshlessGas
from quintet.interfaces.params import read
params, mistakes = read(MeshlessGas.Params, {{
    "axisymmetric": True, "initial": {STREAM}, "viscous": VISCOUS,
    "sphere": {{"radius": 1.0, "points_around": 8, "layers": {{"count": 6}}}},
    "boundaries": {{"wall": WALL, "far": {{"kind": "inflow", "state": {STREAM}}},
                    "exit": {{"kind": "outflow"}}}},
}}, "gas")
assert not mistakes, mistakes
MeshlessGas(params)
print(*sys.modules)
"""


def loaded(viscous: bool, wall: str) -> str:
    """What a process has loaded that puts a sphere into a stream."""
    code = CODE.replace("VISCOUS", str(viscous)).replace("WALL", wall)
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert found.returncode == 0, found.stderr
    return found.stdout


def test_friction_is_loaded_only_where_the_gas_has_it() -> None:
    assert "meshless_gas.viscous" not in loaded(False, "{'kind': 'slip'}")
    assert "meshless_gas.viscous" in loaded(True, "{'kind': 'isothermal', 'temperature': 1.0}")
