"""What is refused of bodies that carry clouds, and why."""

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.moving.layout import CloudLayout
from quintet.components.meshless_gas.moving_bodies import Moving
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.errors import QuintetError, SceneError, StepError

BLOCK = 8  # fewest neighbours of a node
ROUNDING = 1e-9  # of a length or a speed, which is taken for none


def refuse_places(layout: CloudLayout, centre: Array, is_first: bool = False) -> None:
    """Refuse bodies that touch, or whose cloud would leave the box.

    Parameters
    ----------
    layout : CloudLayout
    centre : (b, 3) m
        Of bodies.
    is_first
        Whether this is where the scene puts them: it is then the scene that is wrong.
    """
    error: type[QuintetError] = SceneError if is_first else StepError
    farther = "Make" if is_first else "End the run before, or make"
    radii, thickness = layout.radii, layout.thickness
    reach = radii + thickness + 2.0 * layout.spacing
    for b, place in enumerate(centre):
        for d, side in layout.open_sides:
            if layout.is_cut[b] and (d, side) == (0, 1):  # the cloud ends at this face
                continue
            beyond = side * (place[d] - layout.box[int(side > 0), d]) + reach[b]
            if beyond > 0.0:
                where = f"moving.bodies.{b}: " if is_first else ""
                raise error(
                    f"{where}body {b} with its cloud of {radii[b] + thickness[b]:.4g} m must "
                    f"stay within the box; it is at {np.round(place, 6).tolist()} m, "
                    f"{beyond:.3g} m too near to its face across {'xyz'[d]}. {farther} the box "
                    "longer."
                )
        for c in range(b):
            gap = float(np.sqrt(((place - centre[c]) ** 2).sum())) - radii[b] - radii[c]
            least = 2.0 * (layout.second[b] + layout.second[c])
            if gap < least:
                where = f"moving.bodies.{b}: " if is_first else ""
                raise error(
                    f"{where}bodies {c} and {b} must leave room for two layers of nodes on each, "
                    f"{least:.3g} m; found {gap:.3g} m between them. Finer first layers let them "
                    "come nearer; contact itself cannot be computed."
                )


def refuse_scene(params: MeshlessGasParams, keys: Moving) -> None:
    """Refuse what bodies that carry clouds do not go with."""
    for is_wrong, sentence in (*_rules_of_the_gas(params, keys), *_rules_of_bodies(params, keys)):
        if is_wrong:
            raise SceneError(sentence)
    refuse_sector(params)


def _rules_of_the_gas(params: MeshlessGasParams, keys: Moving) -> list[tuple[bool, str]]:
    """What of the gas is wrong round bodies that carry clouds, and how to correct it."""
    count, floor = params.neighbour_count, 0.0 if params.box is None else params.box.lowest[2]
    on_axis = params.kind_of("z-") == "symmetry" and floor == 0.0
    jitter = 0.0 if params.box is None else params.box.jitter
    return [
        (
            count < BLOCK,
            f"bodies that carry clouds need {BLOCK} neighbours at least; found {count}. Correct "
            "neighbours.",
        ),
        (
            params.box is None,
            "bodies that carry clouds need a box around them. Give a box.",
        ),
        (
            keys.axisymmetric and not on_axis,
            "an axisymmetric flow needs a box that begins at z = 0 with symmetry there; found "
            f"{params.kind_of('z-')} at {floor:g} m. Correct the box, or "
            'boundaries."z-".',
        ),
        (
            keys.axisymmetric and not params.planar,
            "bodies on an axis of symmetry need two dimensions; found 3. Leave out axisymmetric, "
            "or dimensions.",
        ),
        (
            params.viscous and keys.fringe_order == 1,
            "friction needs gradients at overlaps, too; found fringe_order = 1. Leave it out.",
        ),
        (
            keys.line_stencils and (params.planar or jitter > 0.0),
            "neighbours along lines alone are for three dimensions and lattices without jitter. "
            "Leave out line_stencils, or jitter.",
        ),
    ]


def _rules_of_bodies(params: MeshlessGasParams, keys: Moving) -> list[tuple[bool, str]]:
    """What of the bodies does not go with the gas, and how to correct it."""
    no_slip = any(body.is_no_slip for body in keys.bodies)
    return [
        (
            no_slip and not params.viscous,
            "walls of a temperature, or adiabatic ones, hold the gas by friction. Say viscous = "
            "true, or leave out temperature and is_adiabatic.",
        ),
        *(
            (
                params.planar and bool(body.centre[1] or body.velocity[1]),
                "bodies in two dimensions lie and move in the plane y = 0; found centre "
                f"{list(body.centre)} m, velocity {list(body.velocity)} m/s. Leave y at 0.",
            )
            for body in keys.bodies
        ),
    ]


def refuse_sector(params: MeshlessGasParams) -> None:
    """Refuse clouds that end where the box does not, or where no gas leaves."""
    assert params.moving is not None and params.box is not None
    end = params.box.highest[0]
    for b, body in enumerate(params.moving.bodies):
        if body.is_cut and (body.centre[0] != end or params.kind_of("x+") != "outflow"):
            raise SceneError(
                f"the cloud of body {b} ends in the plane x = {body.centre[0]:g} m, as its sector "
                f"says; the box must end there too, as an outflow. Found {end:g} m and "
                f'{params.kind_of("x+")}. Correct box.highest, or boundaries."x+".'
            )


def refuse_jump(moved: Array, centre: Array, spacing: Array, bodies: NDArray[np.int64]) -> None:
    """Refuse motion that does not go on from where bodies are, by more than a spacing."""
    wrong = np.flatnonzero(np.abs(moved - centre).max(axis=1) > spacing)
    if len(wrong):
        k = wrong[0]
        raise SceneError(
            f"bodies must begin and go on where the gas has them; body {bodies[k]} is at "
            f"{centre[k].tolist()} m, and its partner says {moved[k].tolist()} m. Give both the "
            "same position, or shorten the window."
        )


def too_few(count: int, place: Array) -> str:
    """Say that a node has too few neighbours."""
    return (
        f"nodes need {count} neighbours in sight that surround them; that at "
        f"{np.array2string(place, precision=4)} m has not. Make spacings on both sides of the "
        "overlap alike, or clouds thicker."
    )


def refuse_partner(static: Fields, radii: Array, bodies: NDArray[np.int64]) -> None:
    """Refuse partners that have other bodies than the gas, or smaller ones.

    Parameters
    ----------
    static : mapping of arrays
        What is known of the partner's bodies as they are joined.
    radii : (b,) m
        Of all bodies of the gas.
    bodies : (d,) int array
        Those that are driven.
    """
    if "motion.radius" not in static:
        return
    sizes = 2.0 * static["motion.radius"]  # m
    if len(sizes) != len(bodies):
        raise SceneError(
            f"each driven body needs a partner; found {len(bodies)} driven bodies and "
            f"{len(sizes)} of the partner. Give both as many."
        )
    diameters = 2.0 * radii[bodies]
    wrong = np.flatnonzero(sizes < diameters * (1.0 - ROUNDING))
    if len(wrong):
        k = wrong[0]
        raise SceneError(
            f"moving.bodies.{bodies[k]}: the partner's body must be at least as large as that in "
            f"the gas, {diameters[k]:.6g} m across, as they would overlap in contact; found "
            f"{sizes[k]:.6g} m. Give both the same radius; the partner's may be larger, that "
            "layers of nodes fit between bodies that strike each other."
        )


def refuse_elsewhere(
    partner_centre: Array, centre: Array, radii: Array, bodies: NDArray[np.int64]
) -> None:
    """Refuse partners whose bodies begin at other places than those of the gas.

    Parameters
    ----------
    partner_centre, centre : (d, 3) m
        Of driven bodies, by the partner and by the gas.
    radii : (d,) m
    bodies : (d,) int array
        Numbers of the driven bodies.
    """
    apart = np.sqrt(((partner_centre - centre) ** 2).sum(axis=1))
    wrong = np.flatnonzero(apart > ROUNDING * (radii + np.abs(centre).max(axis=1)))
    if len(wrong):
        k = wrong[0]
        raise SceneError(
            f"moving.bodies.{bodies[k]}: the partner's body must begin where the gas has it, at "
            f"{centre[k].tolist()} m; found {partner_centre[k].tolist()} m. Give both the same "
            "centre."
        )


def refuse_off_plane(centre: Array, velocity: Array, bodies: NDArray[np.int64]) -> None:
    """Refuse bodies that leave the plane of a gas in two dimensions."""
    away = np.abs(centre[:, 1]) > ROUNDING * np.abs(centre).max(axis=1)
    leaving = np.abs(velocity[:, 1]) > ROUNDING * np.abs(velocity).max(axis=1)
    wrong = np.flatnonzero(away | leaving)
    if len(wrong):
        k = wrong[0]
        raise SceneError(
            "bodies in two dimensions lie and move in the plane y = 0; the partner of body "
            f"{bodies[k]} is at {centre[k].tolist()} m with {velocity[k].tolist()} m/s. Launch it "
            "in this plane, or compute the gas in three dimensions."
        )


def refuse_off_axis(centre: Array, velocity: Array, spin: Array, bodies: NDArray[np.int64]) -> None:
    """Refuse bodies that leave the axis of symmetry, or turn across it."""
    wrong = np.flatnonzero((np.abs(centre[:, 2]) > 0.0) | (np.abs(velocity[:, 2]) > 0.0))
    if len(wrong):
        k = wrong[0]
        raise SceneError(
            f"bodies of an axisymmetric flow lie and move on the axis; body {bodies[k]} is at "
            f"{centre[k].tolist()} m with {velocity[k].tolist()} m/s. Launch it along x."
        )
    turning = np.flatnonzero(np.abs(spin).max(axis=1) > 0.0)
    if len(turning):
        k = turning[0]
        raise SceneError(
            f"spheres of an axisymmetric flow do not turn about y; body {bodies[k]} turns with "
            f"{spin[k].tolist()} rad/s. Launch it without angular velocity."
        )
