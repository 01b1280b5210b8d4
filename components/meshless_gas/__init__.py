"""Compressible gas on clouds of nodes, by weighted least squares.

    dq_i/dt = -2 Σ_j |c_ij| (F(q_L, q_R; n_ij) - F(q_i; n_ij)),   n_ij = c_ij/|c_ij|

with one flux AUSMPW+ for each pair along its coefficient c_ij = M_i⁻¹ ω_ij r_ij, M_i = Σ ω_ij r_ij
r_ijᵀ. Sides of a pair by MUSCL with κ = 1/3 and limiter 2 of van Albada, or another of `limiters`,
on density, velocity and pressure; where the pressure around a pair falls far below its own, and
where a side would have hardly any density or pressure left, the scheme is of first order. SSP-RK3
in time. The gas is perfect. Two dimensions are x and z, 1 m deep; an axis of symmetry is x, its
meridional plane x, z.

Papers: Sposobin, Calculation of the large particle interaction with a supersonic shock layer using
the meshless algorithm; Katz & Jameson, AIAA J. 48 (2010) 1756; Kim, Kim & Rho, J. Comput. Phys. 174
(2001) 38; van Albada, van Leer & Roberts, Astron. Astrophys. 108 (1982) 76; Shu & Osher, J. Comput.
Phys. 77 (1988) 439.
"""

from quintet.components.meshless_gas.driven_bodies import complete
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.plan import plan
from quintet.components.meshless_gas.ports import SHOWS, initial, ports
from quintet.interfaces.manifest import Manifest

__all__ = ["MANIFEST", "MeshlessGasParams"]

MANIFEST = Manifest(
    kind="meshless_gas",
    title="Compressible gas on clouds of nodes",
    params=MeshlessGasParams,
    component="quintet.components.meshless_gas.component:MeshlessGas",
    ports=ports,
    shows=SHOWS,
    ranks=True,
    plan=plan,
    initial=initial,
    complete=complete,
    bench="quintet.components.meshless_gas.bench:cases",
    conform="quintet.components.meshless_gas.conform:cases",
    opencl="quintet.components.meshless_gas.opencl.device_gas:DeviceGas",
    opencl_ranks="quintet.components.meshless_gas.ranks.refusal:refuse_what_needs_one_device",
)
