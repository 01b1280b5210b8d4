"""The parts of a gas that its parameters ask for.

Each is imported where a scene asks for it: a scene imports, and compiles, nothing that it leaves
out.
"""

from quintet.components.meshless_gas.build import Domain, domain
from quintet.components.meshless_gas.params import MeshlessGasParams, has_walls
from quintet.components.meshless_gas.parts import (
    FixedNodes,
    Inviscid,
    Monitor,
    NodeMotion,
    NoWalls,
    Part,
    TransientFlow,
    WallFriction,
    Walls,
)
from quintet.components.meshless_gas.ranks.one import OneRank, Ranks
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array, Resources


def ranks(params: MeshlessGasParams, resources: Resources) -> Ranks:
    """The ranks that share out the nodes."""
    communicator = resources.communicator
    if communicator is None or communicator.size == 1:
        return OneRank()
    if params.moving is not None or params.particles is not None:
        # Only a gas of several ranks loads mpi4py.
        from quintet.components.meshless_gas.ranks.whole_cloud import WholeCloud

        return WholeCloud(communicator, grain(resources))
    # Only a gas of several ranks loads mpi4py.
    from quintet.components.meshless_gas.ranks.divided_nodes import DividedNodes

    return DividedNodes(communicator, grain(resources))


def grain(resources: Resources) -> int:
    """Nodes of which a rank owns whole multiples: as many as a device adds up together."""
    if resources.device == "cpu":
        return 1
    # Loads no pyopencl, and only a gas on devices asks for it.
    from quintet.components.shared.opencl.arrays import GROUP

    return GROUP


def node_motion(params: MeshlessGasParams, team: Team) -> NodeMotion:
    """Nodes that stand still, or that go with bodies."""
    if params.moving is None:
        return FixedNodes(domain(params, team))
    # Left out of scenes without bodies that carry clouds.
    from quintet.components.meshless_gas.moving.build import moving_clouds

    return moving_clouds(params, team)


def friction(params: MeshlessGasParams, motion: NodeMotion, team: Team) -> WallFriction:
    """Viscosity and heat conduction."""
    if not params.viscous:
        return Inviscid()
    # Left out of scenes without friction.
    from quintet.components.meshless_gas.viscous.terms import Viscous

    return Viscous(params, motion.domain, team)


def axis_terms(params: MeshlessGasParams, viscous: WallFriction, team: Team) -> list[Part]:
    """Terms of an axis of symmetry, of bodies that carry clouds."""
    if params.moving is None or not params.moving.axisymmetric:
        return []
    # Left out of scenes without such an axis.
    from quintet.components.meshless_gas.axis.inviscid import AxisTerms

    terms: list[Part] = [AxisTerms(params.gas.gamma, team)]
    if params.viscous:
        # Left out of scenes without friction.
        from quintet.components.meshless_gas.axis.viscous import AxisStresses
        from quintet.components.meshless_gas.viscous.terms import Viscous

        assert isinstance(viscous, Viscous)
        terms.append(AxisStresses(viscous, team))
    return terms


def particles(params: MeshlessGasParams, motion: NodeMotion) -> list[Part]:
    """Point particles of a partner."""
    if params.particles is None:
        return []
    # Left out of scenes without particles.
    from quintet.components.meshless_gas.point_particles.point_particles import CoupledParticles

    return [CoupledParticles(params, motion.domain)]


def walls(params: MeshlessGasParams, motion: NodeMotion, no_slip: WallFriction) -> Walls:
    """Loads on the walls of the cloud."""
    if not has_walls(params):
        return NoWalls()
    # Left out of scenes without such walls.
    from quintet.components.meshless_gas.wall_loads import WallLoads

    return WallLoads(params, motion.domain, no_slip)


def monitor(
    params: MeshlessGasParams, loads: Walls, primitive: Array, domain: Domain, ranks: Ranks
) -> Monitor:
    """Judge of a flow that is to settle."""
    if params.steady is None:
        return TransientFlow()
    # Left out of scenes without `steady`.
    from quintet.components.meshless_gas.steady import SteadyMonitor

    return SteadyMonitor(params.steady, loads, primitive, domain, ranks)
