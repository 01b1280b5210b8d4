"""Clouds and settings that are too coarse for what they hold, as far as the start shows it."""

import numpy as np

from quintet.components.meshless_gas.blunt_bodies import shock_radius
from quintet.components.meshless_gas.boundaries import NO_SLIP
from quintet.components.meshless_gas.build import Domain
from quintet.components.meshless_gas.params import MeshlessGasParams

# Nodes at which errors were found to be about 10 %.
ALONG_TUBE = 20  # between the ends of a tube: contact, shock and rarefaction take five each
OF_VORTEX = 2.0  # in the radius of a vortex
ACROSS_GAP = 5  # between walls that hold the gas
CHANGE, FORCE = 2e-5, 2e-4  # of a flow that counts as settled: with 1e-4 it may be 13 % off
OF_SHOCK = 6  # between a sphere and its bow shock


def coarse_clouds(params: MeshlessGasParams, domain: Domain) -> dict[str, str]:
    """Say why results are wrong by 10 % and more, however long the run is."""
    warnings = {}
    if params.order == 1:
        warnings["order"] = (
            "the scheme of first order was asked for: shocks and layers of friction are then wrong "
            "by 5 to 35 % on clouds on which the second order errs by 1 to 3 %. Leave order out."
        )
    steady = params.steady
    if steady is not None and (steady.change > CHANGE or steady.force > FORCE):
        warnings["steady"] = (
            f"a flow counts as settled that may still be far from it: change {steady.change:g} and "
            f"force {steady.force:g}; {CHANGE:g} and {FORCE:g} are known to serve. Lower them."
        )
    coarse = _coarse_box(params) if params.box is not None else _coarse_layers(params, domain)
    return warnings | ({"resolution": coarse} if coarse else {})


def _coarse_box(params: MeshlessGasParams) -> str:
    """Say which of its dimensions a box has too few nodes for."""
    box = params.box
    assert box is not None
    sizes = np.array(box.highest) - np.array(box.lowest)
    cases: list[tuple[str, str, float, float]] = []
    if params.riemann is not None:
        cases.append(("the tube", "nodes along it", sizes[0] / box.finest_spacing, ALONG_TUBE))
    if params.vortex is not None:
        count = params.vortex.radius / box.finest_spacing
        cases.append(("the vortex", "spacings in its radius", count, OF_VORTEX))
    for d in (0, 2) if params.dimensions == 2 else (0, 1, 2):
        if all(params.kind_of("xyz"[d] + side) in NO_SLIP for side in "-+"):
            count = sizes[d] / box.finest_spacing + 1.0
            gap = f"the gap across {'xyz'[d]}"
            wide = (
                4.0 * np.sqrt(params.neighbour_count / np.pi) if params.neighbour_count > 12 else 0
            )
            cases.append((gap, "nodes between its walls", count, max(ACROSS_GAP, wide)))
    return " ".join(
        f"{name} has {count:.3g} {quantity}, at least {least:g} are needed for errors below 10 %. "
        "Lower box.spacing."
        for name, quantity, count, least in cases
        if count < least - 0.5
    )


def _coarse_layers(params: MeshlessGasParams, domain: Domain) -> str:
    """Say that too few nodes lie between a sphere and its bow shock, by Billig's correlation."""
    sphere = params.sphere
    far = params.boundaries["far"].state if sphere is not None else None
    if sphere is None or far is None or not (mach := far.mach(params.gas)) > 1.0:
        return ""
    arms = domain.cloud.positions[: domain.cloud.nodes] - np.array(sphere.centre)
    away = np.linalg.norm(arms, axis=1)
    per_layer = len(arms) // (sphere.layers.count + 1)
    ray = int((-arms[:per_layer, 0] / away[:per_layer]).argmax())  # the nearest to the axis
    shock = sphere.radius * float(shock_radius(np.zeros(1), mach)[0])
    count = int((away[ray::per_layer] < shock).sum())
    if count >= OF_SHOCK:
        return ""
    return (
        f"{count} layers lie between the sphere and its bow shock, at least {OF_SHOCK} are needed "
        "for a stand-off within 10 %. Raise layers.count, or lower margin."
    )
