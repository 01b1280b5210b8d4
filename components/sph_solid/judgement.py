"""Signs that the results are wrong: energy from nowhere, and material that tears of itself.

The energy of an isolated body stays as it is. What rises or falls by is judged against the energy
that was turned over: the largest change of its kinetic, potential or internal energy.

An elastic body stores u = K (ln η + 1/η - 1) + s:s/4G per volume at the start; what its internal
energy has beyond that is heat of the artificial viscosity, which no elastic body would have.

Particles that stretch too far apart stop seeing each other, and the material tears although
nothing has failed (numerical fracture). A bond is a pair of nearest neighbours of the start. It is
lost if its particles are out of each other's reach and none is between them.
"""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from quintet.components.shared.materials.solid import NEVER, Solid
from quintet.components.shared.smoothing.cubic_spline import SUPPORT
from quintet.components.sph_solid.diagnostics import totals
from quintet.components.sph_solid.glue import glued_rows
from quintet.components.sph_solid.method import method, viscosity_warning
from quintet.components.sph_solid.pair_sums import PairSums
from quintet.components.sph_solid.params import SphSolidParams
from quintet.components.sph_solid.ranks.method import Ranks
from quintet.components.sph_solid.state import Array, State, Whole
from quintet.interfaces.params import Vector

if TYPE_CHECKING:
    from quintet.components.shared.contact.penalty import Numbers

ENERGY_EVERY, BONDS_EVERY = 32, 64  # steps
NEAREST = 1.2  # spacings: bonds at the start are no longer
EMPTY = 0.95  # spacings around the middle of a lost bond, where no particle is
NEGLIGIBLE = 1e-6  # of the largest energy: smaller changes are rounding
STILL = 1e-14  # of V ρc²: strains of 1e-7 are rounding too
MOST_GAINED = 0.03  # of the energy turned over
MOST_HEATED = 0.22  # of the energy turned over, in elastic bodies, by the artificial viscosity
FEWEST_LOST = 1e-3  # of all bonds
NEEDED_BY_BONDS = ("identity", "position", "body", "failed", "temperature", "material")


def note_energies(
    state: State, kinetic: float, potential: float, internal: float, in_contact: float = 0.0
) -> None:
    """Extend the ranges of energies [J], and of their sum with contact, by the present ones."""
    energies = np.array([kinetic, potential, internal])
    total = float(energies.sum()) + in_contact - state.work
    if state.steps == 0:
        state.ranges[:] = energies[:, None]
        state.sums[:] = total
    np.minimum(state.ranges[:, 0], energies, out=state.ranges[:, 0])
    np.maximum(state.ranges[:, 1], energies, out=state.ranges[:, 1])
    state.sums[1], state.sums[2] = min(state.sums[1], total), max(state.sums[2], total)


def stored_energy(state: State, rows: Whole, law: Solid) -> Array:
    """Elastic energy (k,) J that some particles of an elastic material store."""
    xx, yy, zz, xy, yz, zx = state.deviator[rows].T
    squares = xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + yz * yz + zx * zx)
    eta = state.density_ratio[rows]
    shear = squares / (4.0 * law.shear * eta)
    bulk = law.bulk * (np.log(eta) + 1.0 / eta - 1.0)
    return np.asarray(state.volume[rows] * (shear + bulk))


def is_elastic(law: Solid) -> bool:
    """Whether nothing but artificial viscosity turns motion into heat in a material."""
    return law.hard >= NEVER and not law.shocks and law.spall >= NEVER


def bonds(state: State, spacing: float) -> Whole:
    """Pairs (b, 2) of particles of one body that are nearest neighbours, by their identities."""
    pairs = cKDTree(state.position).query_pairs(NEAREST * spacing, output_type="ndarray")
    same = state.body[pairs[:, 0]] == state.body[pairs[:, 1]]
    return np.asarray(state.identity[pairs[same]])


class Judge:
    """Takes down signs of wrong results in the state, at steps of certain numbers.

    Parameters
    ----------
    state : State
        At the start.
    laws : list of Solid
        Of the materials.
    params : SphSolidParams
    """

    def __init__(self, state: State, laws: list[Solid], params: SphSolidParams) -> None:
        self.laws, self.params = laws, params
        self.bonds = bonds(state, params.spacing)
        self.is_elastic = np.array([is_elastic(law) for law in laws])
        self.density = np.array([law.density for law in laws])
        self.can_tear = not method(params).total_lagrangian

    def note(
        self, state: State, mass: Array, sums: PairSums, gravity: Vector, ranks: Ranks,
        touching: "Numbers | None",
    ) -> None:  # fmt: skip
        """Take down energies and lost bonds, with masses (n,) kg and sums over faces touched."""
        now = totals(state, mass, glued_rows(state, attached=True), gravity, ranks)
        # What contact with a partner's faces holds or dissipated, less what the faces did.
        brought = touching.brought if touching else 0.0
        note_energies(state, now.kinetic, now.potential, now.internal, brought)
        self._note_viscous(state, sums, ranks)
        if state.steps % BONDS_EVERY == 0 and self.can_tear:
            whole = ranks.whole(state, NEEDED_BY_BONDS)
            if not ranks.rank:
                note_torn(whole, self.bonds, self.laws, self.params)
            ranks.agree(state.torn)

    def _note_viscous(self, state: State, sums: PairSums, ranks: Ranks) -> None:
        """Take down the heat [J] of viscosity in elastic bodies.

        The energy that they store in contact is in their internal energy, and no heat.
        """
        share = self.is_elastic[state.material].astype(np.float64)
        heat = -sums.contact_energy(state, self.density[state.material], share)
        for k in np.flatnonzero(self.is_elastic):
            rows = np.flatnonzero(state.material == k)
            internal = self.laws[k].density * state.volume[rows] * state.energy[rows]
            unstored = internal - stored_energy(state, rows, self.laws[k])
            heat += float(ranks.sums(state, [unstored])[0])
        if state.steps == 0:  # of this run: the state may be that of another
            state.viscous[2] = heat
        heat -= state.viscous[2]
        state.viscous[:2] = heat, min(heat, state.viscous[1])

    def warnings(self, state: State, ranks: Ranks) -> dict[str, str]:
        """Reasons why the results may be wrong, by subject."""
        viscosity = viscosity_warning(self.params)
        texts = {"viscosity": viscosity} if viscosity else {}
        turned = float((state.ranges[:, 1] - state.ranges[:, 0]).max())
        stiff = state.volume * state.sound**2 * self.density[state.material]
        least = STILL * float(ranks.sums(state, [stiff])[0])
        if turned > max(least, NEGLIGIBLE * float(np.abs(state.ranges).max())):
            texts |= _of_energy(state, turned, self.params)
        if state.torn[0] > FEWEST_LOST * len(self.bonds):
            texts["fracture"] = _of_fracture(state, self.params)
        return texts


def note_torn(state: State, pairs: Whole, laws: list[Solid], params: SphSolidParams) -> None:
    """Count the bonds that are lost now, of material that has strength.

    Where a part of a body has failed, its law of failure is at work, and the rest may part.
    """
    row = np.empty(state.particles, np.int64)
    row[state.identity] = np.arange(state.particles)
    i, j = row[pairs].T
    apart = state.position[i] - state.position[j]
    reach = SUPPORT * params.length
    far = np.flatnonzero((apart * apart).sum(axis=1) > reach * reach)
    if not len(far):
        return
    i, j = i[far], j[far]
    whole = _has_strength(state, laws, len(params.bodies))
    far = np.flatnonzero(whole[i] & whole[j])
    middle = 0.5 * (state.position[i[far]] + state.position[j[far]])
    near, _ = cKDTree(state.position).query(middle)
    lost = np.flatnonzero(near > EMPTY * params.spacing)
    if len(lost) and state.torn[0] == 0.0:
        state.torn[1], state.torn[2:] = state.time, middle[lost[0]]
    state.torn[0] = max(state.torn[0], float(len(lost)))


def _has_strength(state: State, laws: list[Solid], bodies: int) -> NDArray[np.bool_]:
    """Which particles (n,) are solid, of bodies of which nothing has failed."""
    solid = np.array([
        law.reference_temperature + law.melting if law.hard < NEVER else NEVER for law in laws
    ])  # fmt: skip
    failed = np.bincount(state.body, state.failed, bodies) > 0.0
    return np.asarray(~failed[state.body] & (state.temperature < solid[state.material]))


def _of_energy(state: State, turned: float, params: SphSolidParams) -> dict[str, str]:
    first, least, greatest = state.sums
    gained, lost = (greatest - first) / turned, (first - least) / turned
    unstored = -float(state.viscous[1]) / turned
    heated = float(state.viscous[0]) / turned
    cure = f"Lower courant (now {params.courant:g}), or raise the viscosities."
    if max(gained, lost, unstored) > MOST_GAINED:
        share, verb = max((gained, "gained"), (lost, "lost"), (unstored, "gained"))
        return {
            "energy": f"the energy of the bodies must change by what is done on them alone; they "
            f"{verb} {100.0 * share:.3g} % of the {turned:.3g} J that were turned over. {cure}"
        }
    if heated > MOST_HEATED:
        return {
            "viscosity": f"elastic bodies must lose no motion; the artificial viscosity turned "
            f"{heated:.0%} of {turned:.3g} J that were turned over into heat. Lower "
            f"viscosity_linear (now {method(params).linear:g}) and viscosity_quadratic (now "
            f"{method(params).quadratic:g}), or the spacing; total_lagrangian needs neither."
        }
    return {}


def _of_fracture(state: State, params: SphSolidParams) -> str:
    count, time, *place = state.torn
    x, y, z = place
    return (
        f"material must not tear unless it fails; {count:.0f} pairs of neighbours were drawn out "
        f"of each other's reach, first near ({x:.4g}, {y:.4g}, {z:.4g}) m at {time:.4g} s "
        "(numerical fracture). Set total_lagrangian = true, or artificial_stress (0.3; now "
        f"{params.artificial_stress:g}), or give the material a law of failure."
    )
