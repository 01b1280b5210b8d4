"""What a run of a gas will need: nodes, step and time, before any node is made."""

from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.manifest import Plan

RATES = {2: 1.2e6, 3: 3e5}  # nodes stepped per second and thread
BYTES = {2: 800.0, 3: 1200.0}  # of a node
SERIAL = 0.1  # share of a step that threads do not shorten: see tests.md, Speed


def plan(params: MeshlessGasParams) -> Plan:
    """What a run will need."""
    size = params.dimensions
    count, step = params.expected_count, params.expected_step
    return Plan(count, step, RATES[size], BYTES[size], serial=SERIAL)
