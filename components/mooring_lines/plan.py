"""What a run of lines will need, estimated without building it."""

import math

from quintet.components.mooring_lines.params import MooringLinesParams
from quintet.interfaces.manifest import Plan

RATE = 1.5e5  # lines computed per second
BYTES = 500.0  # of a line


def plan(params: MooringLinesParams) -> Plan:
    """What a run will need; a step may be as long as a window."""
    return Plan(len(params.lines), math.inf, RATE, BYTES)
