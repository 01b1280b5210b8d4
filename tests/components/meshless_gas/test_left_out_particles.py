"""A gas without particles neither imports nor compiles the kernels of their exchange."""

import subprocess
import sys

PROGRAM = """
import sys
from quintet.components.meshless_gas.component import MeshlessGas, MeshlessGasParams
from quintet.components.meshless_gas.clouds.params import BoxCloud
from quintet.components.meshless_gas.boundaries import GasState
from quintet.components.meshless_gas.particle_coupling import PointParticles
box = BoxCloud(lowest=(0.0, 0.0, 0.0), highest=(1.0, 0.0, 1.0), spacing=0.2)
air = GasState(temperature=300.0, pressure=1e5)
loaded = "quintet.components.meshless_gas.point_particles.kernels"
MeshlessGas(MeshlessGasParams(box=box, initial=air))
assert loaded not in sys.modules
MeshlessGas(MeshlessGasParams(box=box, initial=air, particles=PointParticles()))
assert loaded in sys.modules
"""


def test_without_particles_their_kernels_are_not_imported():
    process = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True)
    assert process.returncode == 0, process.stderr
