"""Why results may be wrong, judged from the present state."""

import numpy as np

from quintet.components.meshless_gas.boundaries import Boundary
from quintet.components.meshless_gas.build import Domain
from quintet.components.meshless_gas.clouds.cloud import INFLOW
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.state import State

BLOCKED = 0.1  # relative difference of the pressure beside an inflow from that of what comes in
FEW, SHARE = 2, 0.25  # nodes, and share of those of the boundary, at which this may be so
SETTLING = 10.0  # spacings that what comes in must have run before it is judged


def blocked_inflows(params: MeshlessGasParams, state: State, domain: Domain) -> dict[str, str]:
    """Say where the gas beside a supersonic inflow has another pressure than what comes in.

    Nothing runs against such an inflow, and it stays as given: a shock that has arrived there would
    leave the cloud.
    """
    cloud, gas = domain.cloud, params.gas
    said = {}
    for number, (name, boundary) in enumerate(_patches(params), start=1):
        if boundary.state is None:
            continue
        density, *velocity, pressure = boundary.state.primitive(gas)
        place = np.flatnonzero(
            (cloud.kind[domain.edges] == INFLOW) & (cloud.patch[domain.edges] == number)
        )
        rows = domain.edges[place]
        into = cloud.normals[rows] @ np.array(velocity)
        supersonic = into > np.sqrt(gas.gamma * pressure / density)
        supersonic &= into * state.time > SETTLING * cloud.spacing[rows]
        near = state.primitive[:, 4][np.minimum(domain.stencils.neighbours[rows], cloud.nodes - 1)]
        beside = (domain.weights[place, : near.shape[1]] * near).sum(axis=1)
        off = np.where(supersonic, np.abs(beside / pressure - 1.0), 0.0)
        # A shock from a corner of the boundary, as over a wedge, is met by one node or two.
        if (off > BLOCKED).sum() > max(FEW, SHARE * supersonic.sum()):
            k = int(off.argmax())
            where = np.array2string(cloud.positions[rows[k]], precision=4)
            said[f"boundaries.{name}"] = (
                f"at {where} m gas comes in faster than sound at {pressure:.4g} Pa, but that "
                f"beside it has {beside[k]:.4g} Pa: a shock stands at the boundary, which cannot "
                "let it out. Move the boundary further away (a sphere: margin, outer_radius)."
            )
    return said


def _patches(params: MeshlessGasParams) -> list[tuple[str, Boundary]]:
    """Boundaries in the order of their numbers."""
    return [
        (n, boundary)
        for n, boundary in params.boundaries.items()
        if params.kind_of(n) != "periodic"
    ]
