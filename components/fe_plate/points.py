"""How many quadrature points the elements have, and what that does to bending."""

from quintet.components.fe_plate.meshes.elements import require_one_kind
from quintet.components.fe_plate.meshes.layers import ENOUGH, fewest_layers
from quintet.components.fe_plate.meshes.params import Part
from quintet.components.fe_plate.params import FePlateParams
from quintet.components.shared.materials.params import material
from quintet.interfaces.errors import SceneError

ALL = 8  # points of a hexahedron with `integration = "full"`
OF_TETRAHEDRA = 4
LEAST_HOURGLASS = 1e-3  # of one point


def points_of(params: FePlateParams) -> int:
    """Quadrature points of each element, 1 or 8, and 4 of tetrahedra."""
    kinds = [part.has_tetrahedra for part in params.parts]
    require_one_kind(kinds)
    if kinds[0]:
        if params.integration == "reduced":
            raise SceneError(
                "integration: tetrahedra with 10 nodes have four quadrature points, as one would "
                'leave most of their modes without stiffness; found "reduced". Leave it out.'
            )
        return OF_TETRAHEDRA
    if params.integration == "full" or (
        params.integration == "auto"
        and not any(is_shocked(part) for part in params.parts)
        and _fewest(params)[0] < ENOUGH
    ):
        return ALL
    if params.hourglass < LEAST_HOURGLASS:
        raise SceneError(
            f"hourglass must be {LEAST_HOURGLASS:g} or more, for nothing else holds patterns "
            f"that one quadrature point does not see; found {params.hourglass:g}. Raise it (0.05 "
            'is usual), or set integration = "full".'
        )
    return 1


def is_shocked(part: Part) -> bool:
    """Whether a part is made for impact: its material has a law of shocks, or of failure."""
    law = material(part.material)
    fails = (law.spall_stress, law.failure_strain, law.damage)
    return law.mie_gruneisen is not None or any(rule is not None for rule in fails)


def integration_notes(params: FePlateParams) -> tuple[str, ...]:
    """Say what few layers do to bending, or that eight points were taken for them."""
    layers, number = _fewest(params)
    if params.integration == "full" or layers >= ENOUGH:
        return ()
    thin = f"parts.{number} has {layers} element{'s' * (layers > 1)} through its thinnest extent"
    if points_of(params) == ALL:
        return (
            f'integration = "full" was taken, eight times the work: {thin}, and with one point '
            f"an element its bending would lack {layers**-2:.0%} of its stiffness.",
        )
    if layers == 1:
        lack = "nothing but the stabilisation bears bending"
    else:
        lack = f"its bending lacks up to 1/n² = {layers**-2:.0%} of its stiffness"
    return (
        f"{thin}; with one quadrature point an element {lack}. Where it bends, set integration = "
        f'"full", or {ENOUGH} elements.',
    )


def _fewest(params: FePlateParams) -> tuple[int, int]:
    """Fewest layers of a part, and its number."""
    return min(
        (fewest_layers(part, params.dimensions), number) for number, part in enumerate(params.parts)
    )
