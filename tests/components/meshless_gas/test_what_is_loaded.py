"""A scene loads only the modules that it needs: friction only where the gas has it."""

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


def loaded_modules(viscous: bool, wall: str) -> str:
    """Modules that a process loads to put a sphere into a stream."""
    code = CODE.replace("VISCOUS", str(viscous)).replace("WALL", wall)
    process = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert process.returncode == 0, process.stderr
    return process.stdout


def test_friction_is_loaded_only_where_the_gas_has_it() -> None:
    assert "meshless_gas.viscous" not in loaded_modules(False, "{'kind': 'slip'}")
    assert "meshless_gas.viscous" in loaded_modules(
        True, "{'kind': 'isothermal', 'temperature': 1.0}"
    )
