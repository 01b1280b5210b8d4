"""What a run of a gas will need: nodes, step and time, before any node is made."""

from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.manifest import Plan

RATES = {2: 1.2e6, 3: 3e5}  # nodes stepped per second and thread
BYTES = {2: 800.0, 3: 1200.0}  # of a node


def plan(params: MeshlessGasParams) -> Plan:
    """What a run will need."""
    size = params.dimensions
    return Plan(params.expected_count, params.expected_step, RATES[size], BYTES[size])
