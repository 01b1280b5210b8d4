"""Optional physics as an object: steady conduction, or heat that is stored."""

from quintet.components.fe_plate.heat.conduction import (
    Conduction,
    SteadyConduction,
    TransientConduction,
)
from quintet.components.fe_plate.heat.params import FeHeatParams
from quintet.components.fe_plate.heat.state import Model
from quintet.components.fe_plate.meshes.arrays import Array


def conduction(params: FeHeatParams, model: Model, times: Array) -> Conduction:
    """How temperatures are stepped; in times (p,) s heat crosses the parts."""
    if params.steady:
        return SteadyConduction(model, params.tolerance)
    return TransientConduction(model, params.tolerance, times)
