"""Which parts have elements that may erode."""

from quintet.components.fe_plate.meshes.params import Part
from quintet.components.fe_plate.params import Erosion, FePlateParams
from quintet.components.shared.materials.params import material


def may_erode(part: Part, by: tuple[Erosion, ...]) -> bool:
    """Whether a part's material fails by one of the criteria that erode elements."""
    law = material(part.material)
    limits = {
        "plastic_strain": law.failure_strain,
        "damage": law.damage,
        "spall": law.spall_stress,
    }
    return any(limits[criterion] is not None for criterion in by)


def eroding_parts(params: FePlateParams) -> tuple[int, ...]:
    """Numbers of the parts whose elements may erode."""
    parts = enumerate(params.parts)
    return tuple(number for number, part in parts if may_erode(part, params.erosion))
