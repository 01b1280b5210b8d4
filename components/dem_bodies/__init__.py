"""Rigid bodies in frictional contact: spheres, rounded boxes, unions of spheres and planes.

    m dv/dt = Σ F + m g + load,   dL/dt = Σ r × F + torque,   ω = R I⁻¹ Rᵀ L,   dq/dt = ½ (0, ω) ∘ q
    F_n = 4/3 E* √R* δ^{3/2} + 2√(5/6) ζ √(S_n m*) dδ/dt ≥ 0          Hertz, damped
    dF_t = -S_t v_t dt, |F_t| ≤ μ F_n                               Mindlin, Coulomb

with S_n = 2E*√(R*δ), S_t = 8G*√(R*δ). The damping ratio ζ realises the coefficient of restitution e
exactly, e = exp(-2ζ arccos ζ/√(1-ζ²)), although the force is never a pull; m* is the mass that
resists at the point of contact, 1/m* = Σ [1/m + (r × n)·I⁻¹(r × n)], so that e holds for the normal
velocity of a box's corner too, and nearly for a box that falls flat on four of them.

A box is what a sphere of radius `edge_radius` sweeps when its centre moves through a smaller box:
its faces are exact. Two boxes touch where a corner of one is near the other (8 + 8 spheres against
rounded boxes) and where two edges cross; that is all that convex polyhedra can do. A sharp edge
yields until it is blunt: contacts of boxes and polygons have at least the radius of a default edge
radius, and that of a body a tenth as thick as it is long, however sharp or thin they are; so they
may be deeper than edges are round (`kernels/sharp.py`). Spheres and their unions touch boxes by
their exact distance. Contacts along an edge or face thus need no row of small spheres, whose bumps
would add to the friction.

An agglomerate is a shape from a file (STL, OBJ, PLY, voxels as .npy) whose surface equal spheres
cover from within; its mass and inertia are those of the shape, and fluids meet the shape itself.

Any of a body's six degrees of freedom may be `locked`: it then keeps its velocity there. Planes are
infinite and at rest, in any pose, and may vanish (`until`); a box with all six locked is a finite
one, at rest or moving. Locks may end (`released_at`).

In two dimensions bodies are discs and polygons in the plane of x and z, prisms of 1 m along y, and
move in it: nothing here pushes them out of it, and what loads would is left out. A disc has the
contacts of a sphere of its radius, a convex polygon those of its rounded corners with the edges of
others; so contacts are softer than those of a cylinder along 1 m, but restitution, friction and
momentum are those of the prisms. A polygon that is not convex has no contacts, and must be alone.

Two materials in contact have the lower of their frictions, restitutions and rolling coefficients;
`pairs` in a scene overrides each of them for two materials, or for one and itself. Rolling
resistance is that of `kernels/rolling_resistance.py`, between spheres, and spheres and planes.

Spheres on their own, the many of a packing, have a list of pairs and kernels of their own: rows
sorted in space, several contacts computed at once, blocks of rows shared out among threads. All
sums have one order, so that the number of threads changes no bit. `contact_points` lists point,
normal, force and depth of each contact; `state.contact_load` is their sum on each body.

Velocity Verlet, of second order also with dampers: their velocities are predicted at the end of
the step. Angular momentum is advanced in world axes, so that it is exact for a free body. The
step is a share of a contact's duration, and shorter where many contacts hold one body, as their
springs and dampers add up.

Papers: Hertz, J. reine angew. Math. 92 (1881) 156; Mindlin & Deresiewicz, J. Appl. Mech. 20 (1953)
327; Tsuji, Tanaka & Ishida, Powder Technol. 71 (1992) 239 (damping); Antypov & Elliott, EPL 94
(2011) 50004; Schwager & Pöschel, Granular Matter 9 (2007) 465 (where a contact ends); Walton &
Braun, J. Rheol. 30 (1986) 949 (unloading); Thornton, Cummins & Cleary, Powder Technol. 233 (2013)
30 (comparison); Chung & Ooi, Granular Matter 13 (2011) 643 (tests).
"""

from quintet.components.dem_bodies.params import DemBodiesParams
from quintet.components.dem_bodies.plan import meeting_notes, meets, plan
from quintet.components.dem_bodies.ports import SHOWS, ports
from quintet.components.dem_bodies.start import initial
from quintet.interfaces.manifest import Manifest

__all__ = ["MANIFEST", "DemBodiesParams"]


MANIFEST = Manifest(
    kind="dem_bodies",
    title="Rigid bodies in frictional contact",
    params=DemBodiesParams,
    component="quintet.components.dem_bodies.component:DemBodies",
    ports=ports,
    plan=plan,
    initial=initial,
    meets=meets,
    meeting_notes=meeting_notes,
    bench="quintet.components.dem_bodies.bench:cases",
    conform="quintet.components.dem_bodies.conform:cases",
    opencl="quintet.components.dem_bodies.component:DemBodies",
    opencl_limits="quintet.components.dem_bodies.opencl.refusal:refuse_what_needs_the_processor",
    opencl_ranks="quintet.components.dem_bodies.opencl.refusal:refuse_what_needs_one_rank",
    shows=SHOWS,
    ranks=True,
    ranks_limits="quintet.components.dem_bodies.ranks.refusal:refuse_what_needs_one_rank",
)
