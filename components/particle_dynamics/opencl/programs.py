"""The program of a lattice: laws, printed for the terms that a scene has, and loops over them."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from quintet.components.particle_dynamics import laws
from quintet.components.particle_dynamics.coefficients import PairDamping, SevenRoots
from quintet.components.particle_dynamics.kernels import generator
from quintet.components.particle_dynamics.ranks.terms import Terms
from quintet.components.particle_dynamics.state import (
    NO_DRIVE,
    PULL_FIRST,
    PULL_SECOND,
    WORK,
    Model,
)
from quintet.components.shared.opencl import cells
from quintet.components.shared.opencl.program import Program
from quintet.components.shared.opencl.types import LANES

HERE = Path(__file__).parent
NO_DAMPING = PairDamping(0.0, 0.0, 0.0, 0.0)
VECTOR = (0.0, 0.0, 0.0)
FAR = 4.0  # spacings: the pair force ends at two
LANES_OF_PROCESSORS = 4  # doubles in one of its vectors; other devices make lanes of points
FREE, FROZEN, COPY = -1, -2, -3  # roles of points; those of a bath have its row
NUMBERS = {
    "WORK": WORK, "PULL_FIRST": PULL_FIRST, "PULL_SECOND": PULL_SECOND, "FROZEN": FROZEN,
    "COPY": COPY,
}  # fmt: skip


class PairTerms(NamedTuple):
    """Numbers of the forces of pairs."""

    law: SevenRoots  # without potentials, which are computed on the host
    damping: PairDamping  # of pairs within a cut-off
    of_all: float  # N s/m, of all pairs
    side: tuple[float, ...]  # m, lengths of periodic sides; 0: open
    per_side: tuple[float, ...]  # 1/m, their inverses
    far: float  # m, where there is no force


def pair_terms(terms: Terms, model: Model) -> PairTerms:
    """Numbers of the forces of pairs."""
    assert isinstance(terms.law, SevenRoots)
    law = terms.law._replace(inner=None, outer=None)  # type: ignore[arg-type]
    period = (np.zeros(6) if terms.period is None else terms.period).tolist()
    far = FAR * terms.spacing
    damping = terms.damping or NO_DAMPING
    return PairTerms(law, damping, model.literal_damping, (*period[:3],), (*period[3:],), far)


def lattice_program(terms: Terms, model: Model, lanes: int) -> str:
    """Forces of pairs, and steps with drive, baths and collisions, in double precision."""
    program, of_pairs = Program("double", lanes), pair_terms(terms, model)
    pair_laws = {
        "force_over_distance": (laws.force_of_roots, of_pairs.law, LANES),
        "weight_of_damping": (laws.weight_of_damping, NO_DAMPING, LANES),
        "damping_over_distance": (laws.damping_over_distance, LANES, LANES, LANES),
        "nearest_image": (laws.nearest_image, LANES, 0.0, 0.0),
    }
    point_laws = {
        "damping_of_all": (laws.damping_over_distance, 0.0, 0.0, 0.0),
        "tether_force": (laws.tether_force, 0.0, 0.0, 0.0),
        "driven_places": (laws.driven_places, NO_DRIVE, 0.0, 0.0, 0.0),
        "driven_rates": (laws.driven_rates, NO_DRIVE, 0.0, 0.0, 0.0),
        "bath_factors": (laws.bath_factors, *(0.0,) * 5),
        "heat_gained": (laws.heat_gained, 0.0, 0.0, 0.0),
        "half_turn": (laws.half_turn, VECTOR, VECTOR),
        "counter_after": (generator.counter_after, 0, 0),
        "uniform_of": (generator.uniform_of, 0),
        "normal_of": (generator.normal_of, 0.0, 0.0),
        "direction_of": (generator.direction_of, 0.0, 0.0),
    }
    names = {
        name: program.add(*arguments)[0] for name, arguments in (pair_laws | point_laws).items()
    }
    names |= {"PairTerms": program.struct(of_pairs), "LANES": str(lanes)}
    names |= {name: str(number) for name, number in NUMBERS.items()}
    terms_of_scene = {
        "PERIODIC": terms.period is not None,
        "DAMPED": terms.damping is not None,
        "DAMPS_ALL": model.literal_damping > 0.0,
        "RANDOM": model.is_random,
    }
    names |= {name: "" for name, is_there in terms_of_scene.items() if is_there}
    search = cells.source(program)
    defined = [f"#define {name} {meaning}" for name, meaning in names.items()]
    sources = ("pairs", "drive", "stages", *(("baths",) if model.is_random else ()))
    kernels = [(HERE / f"{name}.cl").read_text() for name in sources]
    return "\n".join([program.text, *defined, search, *kernels])
