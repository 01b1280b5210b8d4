"""Elastic-plastic structures of hexahedra or ten-node tetrahedra, stepped explicitly.

    M dv/dt = Σ F - ∫ Bᵀσ dV + m g,   dx/dt = v

Hexahedra have one quadrature point, with the mean gradient ∂N/∂x of the corners, so that they pass
the patch test on distorted meshes; what that point does not see is held by the stabilisation of
Flanagan and Belytschko. Tetrahedra have four points. Stress by Jaumann's rate at the middle of the
step, flow stress of Johnson and Cook, equation of state of Mie and Grüneisen, linear and quadratic
bulk viscosity; elements that fail are eroded and their mass stays at the nodes. Velocity Verlet:
velocities are known at the steps' ends, and the impulse of a load is its force times the step to
rounding.

Of all hexahedra the step is bounded by 2/ω with ω² ≤ 2 (K + 4G/3)/ρ Σ B², a proven bound of the
greatest frequency (0.58 of the stable step of cubes); of tetrahedra by the greatest frequency of
their points, each with its share of the nodes' masses (`kernels/ten_nodes.py`).

Papers: Flanagan & Belytschko, Int. J. Numer. Methods Eng. 17 (1981) 679; Belytschko, Liu, Moran &
Elkhodary, Nonlinear Finite Elements (2014), chapter 8; Benson, Comput. Methods Appl. Mech. Eng. 99
(1992) 235 (bulk viscosity); Hinton, Rock & Zienkiewicz, Earthq. Eng. Struct. Dyn. 4 (1976) 245
(masses of tetrahedra); Flanagan & Belytschko, J. Appl. Mech. 51 (1984) 35 (their bound).
"""

from quintet.components.fe_plate.params import FePlateParams
from quintet.components.fe_plate.plan import plan
from quintet.components.fe_plate.ports import SHOWS, ports
from quintet.interfaces.manifest import Manifest

__all__ = ["MANIFEST", "FePlateParams"]

MANIFEST = Manifest(
    kind="fe_plate",
    title="Elastic-plastic structures of finite elements",
    params=FePlateParams,
    component="quintet.components.fe_plate.component:FePlate",
    ports=ports,
    shows=SHOWS,
    plan=plan,
    bench="quintet.components.fe_plate.bench:cases",
    conform="quintet.components.fe_plate.conform:cases",
    ranks=True,
    ranks_limits="quintet.components.fe_plate.ranks.refusal:refuse_what_needs_one_rank",
)
