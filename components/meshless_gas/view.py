"""What a picture shows of a gas: its nodes with their states, and the walls of its box."""

import numpy as np

from quintet.components.meshless_gas.boundaries import NO_SLIP
from quintet.components.meshless_gas.build import Domain, Rows, reaches
from quintet.components.meshless_gas.clouds.cloud import Cloud
from quintet.components.meshless_gas.diagnostics import mach, temperature
from quintet.components.meshless_gas.exact_states import states_at
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.ranks.one import Ranks
from quintet.components.meshless_gas.state import Fluxes, State
from quintet.components.shared.geometry.box_faces import box
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.faces import SYMMETRY, WALL, polygons

DARKEST = 15.0  # exponent of the steepest gradient
CONTRAST = 15.0  # of the greatest curvature: light that it bends is all gone, or twice as bright


def schlieren(gradient: Array) -> Array:
    """Brightness of a numerical schlieren picture, 1 where density is uniform.

    Parameters
    ----------
    gradient : (n,) float array, kg/m4
        Size of the density's gradient.

    Returns
    -------
    (n,) float array

    References
    ----------
    Quirk, Int. J. Numer. Meth. Fluids 18 (1994) 555.
    """
    largest = float(gradient.max(initial=0.0))
    if not largest > 0.0:
        return np.ones_like(gradient)
    return np.asarray(np.exp(-DARKEST * gradient / largest))


def shadowgraph(curvature: Array) -> Array:
    """Brightness of a numerical shadowgraph, 0.5 where the density's gradient is uniform.

    Light is bent towards dense gas: a shock is dark on the side of the thin gas, and bright behind.

    Parameters
    ----------
    curvature : (n,) float array, kg/m5
        Laplacian of the density.

    Returns
    -------
    (n,) float array

    References
    ----------
    Settles, Schlieren and Shadowgraph Techniques, Springer (2001), section 6.1.
    """
    largest = float(np.abs(curvature).max(initial=0.0))
    if not largest > 0.0:
        return np.full_like(curvature, 0.5)
    return np.asarray(0.5 - 0.5 * np.tanh(CONTRAST * curvature / largest))


def laplacian(domain: Domain, rows: Rows, gradients: Array) -> Array:
    """Sum (m,) of the second derivatives of a field at nodes (m,).

    Parameters
    ----------
    domain : Domain
    rows : (m,) int array
    gradients : (n, 3) float array
        Of the field, at all nodes and ghosts.
    """
    near, coefficients = domain.stencils.neighbours[rows], domain.stencils.coefficients[rows]
    rise = gradients[near] - gradients[rows][:, None]
    return np.asarray((coefficients * rise).sum(axis=(1, 2)))


def turn_to_ghosts(cloud: Cloud, slopes: Array) -> None:
    """Write gradients (n, 3) of a scalar at ghosts, from those of the nodes behind."""
    x, y, z = slopes[cloud.owner].T
    for axis in range(3):
        turn = cloud.turn[:, axis]
        slopes[cloud.nodes :, axis] = turn[:, 0] * x + turn[:, 1] * y + turn[:, 2] * z


def view(
    state: State, domain: Domain, fluxes: Fluxes, params: MeshlessGasParams, ranks: Ranks
) -> Fields:
    """Nodes that are not left out; each rank has written the gradients around those it shows."""
    rows, cloud = ranks.shown(domain), domain.cloud
    slopes = fluxes.gradients[:, 0].copy()
    turn_to_ghosts(cloud, slopes)
    has_layers = params.box is None or params.moving is not None
    points, spacing, primitive, gradient, curvature = (
        ranks.collect_shown(array)
        for array in (
            cloud.positions[rows],
            reaches(domain, rows) if has_layers else cloud.spacing[rows],
            state.primitive[rows],
            slopes[rows],
            laplacian(domain, rows, slopes),
        )
    )
    exact = _exact(params, points, state.time) if params.riemann else {}
    return {
        **exact,
        "points": points,
        "spacing": spacing,
        "density": primitive[:, 0].copy(),
        "pressure": primitive[:, 4].copy(),
        "velocity": primitive[:, 1:4].copy(),
        "temperature": temperature(primitive, params.gas),
        "mach": mach(primitive, params.gas),
        "schlieren": schlieren(np.sqrt((gradient * gradient).sum(axis=1))),
        "shadowgraph": shadowgraph(curvature),
    }


def _exact(params: MeshlessGasParams, points: Array, time: float) -> Fields:
    """Exact solution at points (n, 3) m, to be drawn beside the computed one."""
    exact = states_at(params, points, time)
    return {
        "exact_density": exact[:, 0].copy(),
        "exact_pressure": exact[:, 4].copy(),
        "exact_velocity": exact[:, 1:4].copy(),
    }


def walls(params: MeshlessGasParams) -> Fields:
    """Faces of the box that are walls or planes of symmetry; of clouds round bodies none."""
    if params.box is None:
        return {}
    support = {"slip": WALL, "symmetry": SYMMETRY} | dict.fromkeys(NO_SLIP, WALL)
    faces = [name for name in params.boundaries if params.kind_of(name) in support]
    kinds = [support[params.kind_of(name)] for name in faces]
    low, high = list(params.box.lowest), list(params.box.highest)
    if params.planar:
        low[1], high[1] = -0.5, 0.5
    shown = polygons(box(low, high, faces))
    return {**shown, "support": np.array(kinds)} if faces else {}
