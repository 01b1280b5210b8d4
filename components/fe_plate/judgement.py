"""Signs that results are wrong: energy that appears, hourglassing, motion lost to viscosity.

The energy of a structure changes by work from outside alone. Any other change is judged against
the energy that was turned over: the largest change of its kinetic, potential or internal energy.

One quadrature point sees nothing of the patterns in which an element bends: springs hold them in
the place of its own stiffness. By their energy E in an elastic element the bending strain of the
pattern is known, and with it the energy E/r that the pattern would have; of a pattern along the
longest edge L of an element of edges L, a and b

    r = κ κ₁ (K + 4G/3)/E_Y (1 + L²/a² + L²/b²)/3

with κ the scene's `hourglass`, E_Y Young's modulus, and κ₁ = 1.126 of a cube. What the structure
lacks in stiffness is |E/r - E|, over its internal energy. Of material that flows E itself is judged
(a tenth of the internal energy at most is the usual rule).
"""

import numpy as np

from quintet.components.fe_plate.build import Structure
from quintet.components.fe_plate.params import FePlateParams
from quintet.components.fe_plate.ranks.method import Ranks
from quintet.components.fe_plate.state import DEVIATOR, ENERGY, POINT_ROWS, PRESSURE, Array, State
from quintet.components.shared.materials.solid import NEVER, Solid

EVERY = 64  # steps
NOTHING = np.zeros(0)  # J
CUBE = 1.126  # energy of a cube's springs over that of the bending they stand for, by κ M/E_Y
NEGLIGIBLE = 1e-6  # of the largest energy: smaller changes are rounding
MOST_GAINED = 0.05  # of the energy turned over
MOST_HEATED = 0.15  # of the energy turned over, in elastic parts, by the bulk viscosity
MOST_HOURGLASS = 0.08  # of the greatest internal energy: three layers lack a tenth
# Sides whose middles lie at the ends of an element along each of its axes.
ENDS = (((0, 3, 4, 7), (1, 2, 5, 6)), ((0, 1, 4, 5), (3, 2, 7, 6)), ((0, 1, 2, 3), (4, 5, 6, 7)))


def is_elastic(law: Solid) -> bool:
    """Whether nothing but viscosity turns motion into heat in a material."""
    return law.hard >= NEVER and not law.shocks and law.spall >= NEVER


def hourglass_weights(built: Structure, hourglass: float) -> Array:
    """Energy (e,) that elements lack, or have too much of, over that of their springs."""
    mesh, laws = built.mesh, built.laws
    x = mesh.node[built.corners(slice(None))]
    edges = np.stack([
        np.linalg.norm(x[:, high].mean(axis=1) - x[:, low].mean(axis=1), axis=1)
        for low, high in ENDS
    ])  # fmt: skip
    edges[edges == 0.0] = 1.0  # of elements in a plane, 1 m deep
    longest = edges.max(axis=0)
    shape = (longest**2 * (1.0 / edges**2).sum(axis=0)) / 3.0
    stiffness = np.array([_confined(law) if is_elastic(law) else np.inf for law in laws])
    share = CUBE * hourglass * stiffness[mesh.part] * shape
    return np.where(np.isfinite(share), np.abs(1.0 / share - 1.0), 1.0)


def _confined(law: Solid) -> float:
    """K + 4G/3 over Young's modulus."""
    youngs = 9.0 * law.bulk * law.shear / (3.0 * law.bulk + law.shear)
    return (law.bulk + 4.0 / 3.0 * law.shear) / youngs


class Judge:
    """Takes down a structure's energies, and judges its results by them."""

    def __init__(self, params: FePlateParams, built: Structure, has_springs: bool) -> None:
        self.params, self.places, self.mass = params, built.places, built.element_mass
        self.volume, self.weights = built.volume, np.zeros(len(built.volume))
        if has_springs:
            self.weights = hourglass_weights(built, params.hourglass)
        laws, part = built.laws, built.mesh.part
        elastic = np.array([is_elastic(law) for law in laws])[part]
        # Who asks for stiffness damping wants motion to become heat.
        watched = elastic.all() and not params.stiffness_damping
        self.shear = np.array([law.shear for law in laws])[part] if watched else None
        self.bulk = np.array([law.bulk for law in laws])[part]
        self.closed = True  # whether all that is done on the structure is known to second order
        self.ranges = np.zeros((3, 2))  # J, least and greatest kinetic, potential, internal
        self.sums = np.zeros(3)  # J, first, least and greatest sum less what was done on it
        self.most = np.zeros(3)  # J, greatest internal energy, lack by hourglassing, heat

    def note(
        self, state: State, motion: list[Array], works: list[Array], brought: float, ranks: Ranks,
        first: bool,
    ) -> None:  # fmt: skip
        """Take down the energies of the present state.

        Parameters
        ----------
        state
        motion : two (n,) float arrays, J
            Kinetic and potential energies of the nodes.
        works : list of (n or 0,) float arrays, J
            Done on the nodes so far.
        brought : float, J
            Other work done on the structure so far.
        ranks : Ranks
        first : bool
            Whether nothing was taken down before.
        """
        elements = self.mass * self.places.of(state, ENERGY)
        springs = self.places.spring_energy(state)
        heats = NOTHING if self.shear is None else elements - self._stored(state)
        kinetic, potential, *works_done, strain, held, lack, heat = ranks.sums(
            [*motion, *works, elements, springs, self.weights * springs, heats]
        ).tolist()
        internal = strain + held
        energies = np.array([kinetic, potential, internal])
        total = float(energies.sum()) - sum(works_done) - brought
        if first:
            self.ranges[:], self.sums[:] = energies[:, None], total
        self.ranges[:, 0] = np.minimum(self.ranges[:, 0], energies)
        self.ranges[:, 1] = np.maximum(self.ranges[:, 1], energies)
        self.sums[1], self.sums[2] = min(self.sums[1], total), max(self.sums[2], total)
        self.most[:] = np.maximum(self.most, (internal, lack, heat))

    def _stored(self, state: State) -> Array:
        """Elastic energies (e,) J of elements, by small strains."""
        assert self.shear is not None
        rows = state.points.transpose(1, 0, 2).reshape(POINT_ROWS, -1)
        at = self.places.point
        xx, yy, zz, xy, yz, zx = (rows[DEVIATOR + k][at] for k in range(6))
        squares = xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + yz * yz + zx * zx)
        pressure = rows[PRESSURE][at]
        energy = squares / (4.0 * self.shear[:, None]) + pressure**2 / (2.0 * self.bulk[:, None])
        return np.asarray(self.volume * (energy * self.places.share).sum(axis=1))

    def warnings(self) -> dict[str, str]:
        """Reasons why the results may be wrong, by subject."""
        texts: dict[str, str] = {}
        turned = float((self.ranges[:, 1] - self.ranges[:, 0]).max())
        if not turned > NEGLIGIBLE * float(np.abs(self.ranges).max()):
            return texts
        first, least, greatest = self.sums if self.closed else np.zeros(3)
        share, verb = max(
            ((greatest - first) / turned, "gained"), ((first - least) / turned, "lost")
        )
        if share > MOST_GAINED:
            texts["energy"] = (
                "the structure's energy must change only by the work done on it; it "
                f"{verb} {share:.1%} of the {turned:.3g} J that were turned over. Lower courant "
                f"(now {self.params.courant:g})."
            )
        internal, lack, heat = self.most
        if lack > MOST_HOURGLASS * internal and internal > NEGLIGIBLE * turned:
            texts["hourglass"] = (
                "the error in the energy of patterns that one quadrature point does not see must "
                f"be below {MOST_HOURGLASS:.0%} of the internal energy; it is "
                f"{lack / internal:.0%} of {internal:.3g} J. Take more elements through the "
                'thickness, or integration = "full".'
            )
        if heat > MOST_HEATED * turned:
            texts["viscosity"] = (
                "elastic parts must lose no motion; the bulk viscosity turned "
                f"{heat / turned:.0%} of {turned:.3g} J that were turned over into heat. Lower "
                f"viscosity_linear (now {self.params.viscosity_linear:g}) and viscosity_quadratic "
                f"(now {self.params.viscosity_quadratic:g}), or refine the mesh."
            )
        return texts

    def save(self) -> Array:
        """All that was taken down, (12,) J."""
        return np.concatenate([self.ranges.ravel(), self.sums, self.most])

    def load(self, saved: Array) -> None:
        """Restore what was saved."""
        self.ranges[:] = saved[:6].reshape(3, 2)
        self.sums[:], self.most[:] = saved[6:9], saved[9:]
