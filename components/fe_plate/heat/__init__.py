"""Conduction of heat in 8-node solids, steady or stepped implicitly.

    C dT/dt + K T = q,   K = ∫ k ∇N·∇N dV,   C = ∫ ρ c N dV

Trilinear elements, integrated at eight points; heat capacities are lumped at the nodes. Steps are
those of Alexander's diagonally implicit scheme of two stages: of second order, damping what is fast
(L-stable), stable at any size; one longer than 2.4 times the slowest decay overshoots. Linear
systems are solved by conjugate gradients with the diagonal as preconditioner. Heat of steps is
conserved to rounding whatever their tolerance: what a part lacks then is given by what holds it, or
warms it evenly; of what is steady to the tolerance.

A temperature held at a point has no limit under refinement: the heat that enters there goes to
nothing with the elements' size. Hold faces for results that do not depend on the mesh.

Papers: Hughes, The Finite Element Method (1987), chapters 2, 8; Alexander, SIAM J. Numer. Anal. 14
(1977) 1006; Hestenes & Stiefel, J. Res. Natl. Bur. Stand. 49 (1952) 409.
"""

from quintet.components.fe_plate.heat.params import FeHeatParams
from quintet.components.fe_plate.heat.plan import plan
from quintet.components.fe_plate.heat.ports import SHOWS, ports
from quintet.interfaces.manifest import Manifest

__all__ = ["MANIFEST", "FeHeatParams"]

MANIFEST = Manifest(
    kind="fe_heat",
    title="Conduction of heat in finite elements",
    params=FeHeatParams,
    component="quintet.components.fe_plate.heat.component:FeHeat",
    ports=ports,
    shows=SHOWS,
    plan=plan,
    bench="quintet.components.fe_plate.heat.bench:cases",
    conform="quintet.components.fe_plate.heat.conform:cases",
    patience=600.0,  # one steady step of a million elements takes a minute
)
