"""Why results may be wrong, judged from the present state."""

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.blunt_bodies import normal_shock
from quintet.components.meshless_gas.boundaries import Boundary
from quintet.components.meshless_gas.build import Domain
from quintet.components.meshless_gas.clouds.cloud import INFLOW
from quintet.components.meshless_gas.exact.riemann import Side, star
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.ranks.one import Ranks
from quintet.components.meshless_gas.state import State
from quintet.interfaces.component import Array

COMPRESSED = 0.1  # relative rise of the pressure beside an inflow, above which it is judged
# A shock stands still at 1 and runs out above; measured: at most 1.00 where a bow shock stands
# within the last layer of nodes, 1.02 to 5 where the cloud ends before it.
OUTGOING = 1.015
FEW, SHARE = 2, 0.25  # nodes, and share of those of the boundary, at which this may be so
SETTLING = 10.0  # spacings that what comes in must have run before it is judged


def blocked_inflows(
    params: MeshlessGasParams, state: State, domain: Domain, ranks: Ranks
) -> dict[str, str]:
    """Say where a shock would leave through a supersonic inflow, which keeps its state instead."""
    warnings, answered = {}, ranks.answered(domain)
    is_answered = (domain.edges >= answered.start) & (domain.edges < answered.stop)
    for number, (name, boundary) in enumerate(_patches(params), start=1):
        if boundary.state is None:
            continue
        density, *velocity, pressure = boundary.state.primitive(params.gas)
        place = np.flatnonzero(
            is_answered
            & (domain.cloud.kind[domain.edges] == INFLOW)
            & (domain.cloud.patch[domain.edges] == number)
        )
        rows = domain.edges[place]
        into = domain.cloud.normals[rows] @ np.array(velocity)
        sound = float(np.sqrt(params.gas.gamma * pressure / density))
        supersonic = into > sound
        supersonic &= into * state.time > SETTLING * domain.cloud.spacing[rows]
        numbers = (
            domain.cloud.positions[rows],
            into[:, None],
            supersonic[:, None],
            _states_beside(state.primitive, domain, place),
        )
        places, into, supersonic, beside = np.hsplit(
            ranks.collect_answered(np.hstack(numbers)), (3, 4, 5)
        )
        into, supersonic = into[:, 0], supersonic[:, 0] > 0.0
        strengths = np.zeros(len(places))
        for node in np.flatnonzero(supersonic & (beside[:, 2] > (1.0 + COMPRESSED) * pressure)):
            stream = Side(density, into[node], pressure)
            meeting = Side(*beside[node])
            strengths[node] = shock_strength(stream, meeting, params.gas.gamma)
        # A shock from a corner of the boundary, as over a wedge, is met by one node or two.
        if (strengths > OUTGOING).sum() > max(FEW, SHARE * supersonic.sum()):
            k = int(strengths.argmax())
            where = np.array2string(places[k], precision=4)
            warnings[f"boundaries.{name}"] = (
                f"at {where} m gas comes in faster than sound at {pressure:.4g} Pa, and the gas "
                f"beside it, at {beside[k, 2]:.4g} Pa, sends a shock out against it, which the "
                "boundary does not let out. Move the boundary further away (a sphere: margin, "
                "outer_radius)."
            )
    return warnings


def _states_beside(primitive: Array, domain: Domain, place: NDArray[np.int64]) -> Array:
    """Density, velocity into the gas and pressure (a, 3) beside some of the boundary nodes."""
    rows = domain.edges[place]
    near = np.minimum(domain.stencils.neighbours[rows], domain.cloud.nodes - 1)
    weights = domain.weights[place, : near.shape[1]]
    means = (weights[:, :, None] * primitive[near]).sum(axis=1)
    into = (domain.cloud.normals[rows] * means[:, 1:4]).sum(axis=1)
    return np.stack([means[:, 0], into, means[:, 4]], axis=1)


def shock_strength(stream: Side, beside: Side, gamma: float) -> float:
    """Pressure that a supersonic stream rises to where it meets gas, over that of a standing shock.

    The shock of the Riemann problem of both runs out, against the stream, above 1.
    """
    mach = stream.velocity / np.sqrt(gamma * stream.pressure / stream.density)
    _, standing = normal_shock(float(mach), gamma)
    return star(stream, beside, gamma)[0] / (stream.pressure * standing)


def _patches(params: MeshlessGasParams) -> list[tuple[str, Boundary]]:
    """Boundaries in the order of their numbers."""
    return [
        (n, boundary)
        for n, boundary in params.boundaries.items()
        if params.kind_of(n) != "periodic"
    ]
