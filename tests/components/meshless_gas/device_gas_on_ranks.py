"""Program that test_meshless_gas_opencl_ranks.py runs: gases of gas_on_ranks.py on devices.

Each rank names a device, all of them the first.
"""

import json

import gas_on_ranks
from gas_on_ranks import PARAMS
from pydantic import TypeAdapter
from solver_run import COMMUNICATOR, WORLD

from quintet.components.meshless_gas.opencl.device_gas import DeviceGas
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.component import Resources


class Run(gas_on_ranks.Run):
    """A case of a gas on devices."""

    def build(self):
        params = TypeAdapter(MeshlessGasParams).validate_json(json.dumps(PARAMS[self.name]))
        device = "opencl:" + ",".join("0" * WORLD.size)
        return DeviceGas(params, Resources(1, communicator=COMMUNICATOR, device=device))
