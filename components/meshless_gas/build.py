"""A gas as its parameters describe it: its cloud, its boundaries, its state at the start."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.boundaries import Boundary, Gas
from quintet.components.meshless_gas.clouds.box import box
from quintet.components.meshless_gas.clouds.cloud import (
    INFLOW,
    INNER,
    OUTFLOW,
    SLIP,
    Cloud,
    is_advanced,
    is_mirrored,
)
from quintet.components.meshless_gas.clouds.layers import Sides
from quintet.components.meshless_gas.exact_states import states_at
from quintet.components.meshless_gas.kernels.boundaries import write_weights
from quintet.components.meshless_gas.kernels.motion import write_conservative
from quintet.components.meshless_gas.kernels.outflows import Outflows, outflows
from quintet.components.meshless_gas.laws.boundaries import (
    BACK_PRESSURE,
    PATCH_COLUMNS,
    TOTAL_PRESSURE,
    TOTAL_TEMPERATURE,
)
from quintet.components.meshless_gas.laws.transport import Transport
from quintet.components.meshless_gas.layered_clouds import layered_cloud
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.sidedness import EVEN, UNEVEN, doubts_of, notes_of, surround
from quintet.components.meshless_gas.state import State, conserved
from quintet.components.meshless_gas.stencils import (
    Stencils,
    graded_neighbours,
    nearest_neighbours,
    stencils,
)
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError

Rows = NDArray[np.int32]


class Domain(NamedTuple):
    """All that is known before the first step."""

    cloud: Cloud
    stencils: Stencils
    inner: Rows  # (m,) nodes that are advanced
    every: Rows  # (n,) all nodes but ghosts
    edges: Rows  # (b,) inflows, outflows and slip walls
    weights: Array  # (b, K) 1, of their neighbours within
    outflows: Outflows
    bounding: Rows  # (a,) all boundary nodes
    patches: Array  # (p, PATCH_COLUMNS), what the scene says of each boundary
    mirrored: Rows  # (s,) nodes of walls that are planes of symmetry
    ghosts: Rows | None = None  # (r,) whose gradients a rank needs, from the first; None: of all
    written: Rows | None = None  # (w,) boundary nodes whose states a rank computes; None: all
    notes: tuple[str, ...] = ()  # what was changed about the neighbours that the scene asks for
    doubts: tuple[str, ...] = ()  # why no result on this cloud is to be trusted


def domain(params: MeshlessGasParams, team: Team) -> Domain:
    """Build the cloud, and the coefficients of its derivatives."""
    names = [name for name in params.boundaries if params.kind_of(name) not in ("periodic",)]
    cloud, stencil, notes, doubts = _cloud(params, names, team)
    neighbours, kind = stencil.neighbours, cloud.kind[: cloud.nodes]
    edges = _rows(np.isin(kind, (INFLOW, OUTFLOW, SLIP)))
    weights = np.empty((len(edges), neighbours.shape[1]))
    lacks = write_weights(
        edges, cloud.kind, cloud.normals, neighbours, stencil.coefficients, weights
    )
    if lacks >= 0:
        place = np.array2string(cloud.positions[edges[lacks]], precision=4)
        raise SceneError(
            f"boundary nodes must have a neighbour within; that at {place} m has none among its "
            f"{neighbours.shape[1]}. Raise neighbours."
        )
    states = [patch(params.boundaries[name], params.gas) for name in names]
    patches = np.array([np.zeros(PATCH_COLUMNS), *states])
    return Domain(
        cloud=cloud,
        stencils=stencil,
        inner=_rows(is_advanced(kind)),
        every=np.arange(cloud.nodes, dtype=np.int32),
        edges=edges,
        weights=weights,
        outflows=outflows(cloud, neighbours),
        bounding=_rows(kind != INNER),
        patches=patches,
        mirrored=_rows(is_mirrored(kind)),
        notes=notes,
        doubts=doubts,
    )


def _rows(chosen: NDArray[np.bool_]) -> Rows:
    return np.flatnonzero(chosen).astype(np.int32)


def _cloud(
    params: MeshlessGasParams, names: list[str], team: Team
) -> tuple[Cloud, Stencils, tuple[str, ...], tuple[str, ...]]:
    """Nodes, the stencil of each, what was changed about the neighbours, and doubts about them."""
    faces = {name: params.kind_of(name) for name in params.boundaries}
    patches = {name: 1 + number for number, name in enumerate(names)}
    if params.box is None:
        layers = layered_cloud(params, Sides(faces, patches))
        stencil = stencils(layers.cloud, layers.neighbours, params.planar, team)
        keys = params.plate or params.sphere
        is_moved = keys is not None and keys.layers.jitter > 0.0
        doubts = doubts_of(layers.cloud, stencil, params.planar, team) if is_moved else ()
        return layers.cloud, stencil, (), doubts
    lattice, count = params.box, params.neighbour_count
    cloud = box(
        lattice.lowest,
        lattice.highest,
        lattice.spacing,
        faces,
        patches,
        jitter=lattice.jitter,
        seed=lattice.seed,
        weight=lattice.weight,
        neighbours=count,
        planar=params.planar,
        parts=[part.part for part in lattice.refinements],
    )
    find = graded_neighbours if lattice.refinements else nearest_neighbours
    limit = EVEN if params.neighbours is None else UNEVEN
    cure = surround(cloud, find, count, lattice.jitter == 0.0, limit, params.planar, team)
    is_asked = params.neighbours is not None
    notes = notes_of(cure, count, cloud.nodes, params.planar) if is_asked else ()
    return cloud, cure.stencils, notes, ()


def reaches(domain: Domain, rows: Rows) -> Array:
    """Distance (m,) m of nodes' farthest neighbours: layers are thinner than they are wide."""
    positions = domain.cloud.positions
    arms = positions[domain.stencils.neighbours[rows]] - positions[rows][:, None]
    return np.asarray(np.sqrt((arms**2).sum(axis=2)).max(axis=1))


def transport_of(gas: Gas) -> Transport:
    """Viscosity and conduction of a gas."""
    heat = gas.gamma * gas.gas_constant / (gas.gamma - 1.0)  # J/(kg K), c_p
    return Transport(
        viscosity=gas.viscosity,
        reference=gas.reference_temperature,
        sutherland=gas.sutherland,
        conduction=heat / gas.prandtl,
        gas_constant=gas.gas_constant,
    )


def patch(boundary: Boundary, gas: Gas) -> Array:
    """What a boundary says, as kernels take it."""
    row = np.zeros(PATCH_COLUMNS)
    if boundary.state is not None:
        row[:5] = boundary.state.primitive(gas)
    if boundary.total is not None:
        row[1:4] = np.array(boundary.total.direction) / np.linalg.norm(boundary.total.direction)
        row[TOTAL_PRESSURE] = boundary.total.pressure
        row[TOTAL_TEMPERATURE] = boundary.total.temperature
    row[BACK_PRESSURE] = boundary.pressure or 0.0
    return row


def initial_state(params: MeshlessGasParams, cloud: Cloud, team: Team) -> State:
    """State at the start."""
    positions = cloud.positions[: cloud.nodes]
    if params.riemann is not None or params.vortex is not None:
        primitive = states_at(params, positions, 0.0)
    else:
        assert params.initial is not None
        primitive = np.tile(params.initial.primitive(params.gas), (len(positions), 1))
        for number, zone in enumerate(params.zones):
            held = (positions >= zone.lowest) & (positions <= zone.highest)
            if params.planar:
                held[:, 1] = True
            rows = held.all(axis=1)
            if not rows.any():
                raise SceneError(
                    f"zones.{number}: its box must hold a node; it holds none. Correct lowest "
                    f"{list(zone.lowest)} m and highest {list(zone.highest)} m, or take a smaller "
                    "spacing."
                )
            primitive[rows] = zone.state.primitive(params.gas)
    conservative = np.empty_like(primitive)
    write_conservative(primitive, params.gas.gamma, conservative)
    begun = conserved(conservative, cloud.volumes, team)
    return State(conservative, primitive, np.zeros(5), begun)
