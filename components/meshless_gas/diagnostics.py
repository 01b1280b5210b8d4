"""What is told of a gas: balances, errors, and why a step failed."""

import numpy as np

from quintet.components.meshless_gas.boundaries import Gas
from quintet.components.meshless_gas.build import Domain
from quintet.components.meshless_gas.clouds.cloud import INNER
from quintet.components.meshless_gas.exact_states import states_at
from quintet.components.meshless_gas.kernels.motion import write_changes
from quintet.components.meshless_gas.kernels.sums import add_errors
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.ranks.one import Ranks
from quintet.components.meshless_gas.sidedness import UNEVEN, sidedness
from quintet.components.meshless_gas.state import Fluxes, State, conserved
from quintet.components.meshless_gas.thread_grain import LIGHT, WHOLESALE
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array, Fields, Totals
from quintet.interfaces.errors import StepError

SAFE = 0.8  # share of 1/Σ(|v·c| + a|c|) that steps may take in every flow that was tried
ROUNDING = 1e-12  # of the mass flow at the speed of sound


def balance(
    params: MeshlessGasParams,
    state: State,
    domain: Domain,
    fluxes: Fluxes,
    team: Team,
    ranks: Ranks,
) -> Fields:
    """Fields of the port `balance`."""
    counted = np.ones(5)
    if params.has_rings:  # across the axis whole rings have no momentum
        counted[2:4] = 0.0
    entered = counted * state.entered
    now = counted * ranks.conserved(domain, state.conservative, team)
    mass, energy = state.begun[0], state.begun[4]
    scale = np.array([mass, *[np.sqrt(2.0 * mass * energy)] * 3, energy])
    drift = (now - counted * state.begun - entered) / scale
    through = _through(domain, fluxes.primitive, params.gas.gamma)
    inflow, outflow = through[through > 0.0].sum(), -through[through < 0.0].sum()
    return {
        "balance.mass": now[:1],
        "balance.momentum": now[None, 1:4],
        "balance.energy": now[4:],
        "balance.mass_entered": entered[:1],
        "balance.momentum_entered": entered[None, 1:4],
        "balance.energy_entered": entered[4:],
        "balance.mass_drift": drift[:1],
        "balance.momentum_drift": drift[None, 1:4],
        "balance.energy_drift": drift[4:],
        "balance.inflow": np.array([inflow]),
        "balance.outflow": np.array([outflow]),
        "balance.imbalance": np.array([(inflow - outflow) / inflow if inflow > 0.0 else 0.0]),
        "balance.change": np.array([state.change]),
    }


def density_change(state: State, domain: Domain, fluxes: Fluxes, team: Team, ranks: Ranks) -> float:
    """Root mean square of the relative change of densities in the nodes' own steps."""
    nodes = ranks.share(domain).inner
    changes = fluxes.changes[: len(nodes)]
    team.run(
        write_changes, len(nodes), nodes, fluxes.residual, fluxes.bounds, state.conservative,
        changes, fewest=LIGHT,
    )  # fmt: skip
    return float(np.sqrt(ranks.mean(domain, changes)))


def _through(domain: Domain, primitive: Array, gamma: float) -> Array:
    """Mass (a,) kg/s that enters at boundary nodes; 0 where it is rounding, as at walls."""
    states, areas = primitive[domain.bounding], domain.cloud.areas[domain.bounding]
    through = states[:, 0] * (areas * states[:, 1:4]).sum(axis=1)
    sound = np.sqrt(gamma * states[:, 4] * states[:, 0]) * np.abs(areas).sum(axis=1)
    return np.where(np.abs(through) > ROUNDING * sound, through, 0.0)


def errors(
    params: MeshlessGasParams, state: State, domain: Domain, team: Team, ranks: Ranks
) -> Fields:
    """Fields of the port `error`: over nodes within."""
    cloud, rows = domain.cloud, ranks.answered(domain)
    inner = rows.start + np.flatnonzero(cloud.kind[rows] == INNER)
    exact = np.empty((len(inner), 5))

    def write_exact(first: int, last: int) -> None:
        places = cloud.positions[inner[first:last]]
        exact[first:last] = states_at(params, places, state.time)

    team.run(write_exact, len(inner), fewest=WHOLESALE)
    sums = np.zeros((2, 5))
    ranks.in_turn(
        lambda sums: add_errors(inner, cloud.volumes, state.primitive, exact, *sums), sums
    )
    summed, largest = sums
    mean = summed / ranks.total(cloud.volumes[inner])
    return {
        "error.density": mean[:1],
        "error.velocity": mean[1:2],
        "error.pressure": mean[4:],
        "error.largest_density": largest[:1],
    }


def temperature(primitive: Array, gas: Gas) -> Array:
    """Temperature (n,) K."""
    return np.asarray(primitive[:, 4] / (gas.gas_constant * primitive[:, 0]))


def mach(primitive: Array, gas: Gas) -> Array:
    """Mach number (n,)."""
    square = (primitive[:, 1:4] ** 2).sum(axis=1)
    return np.asarray(np.sqrt(square * primitive[:, 0] / (gas.gamma * primitive[:, 4])))


def totals(
    params: MeshlessGasParams, state: State, domain: Domain, team: Team, ranks: Ranks
) -> Totals:
    """Mass, momentum and energies of all nodes."""
    cloud = domain.cloud
    volumes, positions, conservative, primitive = (
        ranks.collect(domain, array)
        for array in (
            cloud.volumes[: cloud.nodes],
            cloud.positions[: cloud.nodes],
            state.conservative,
            state.primitive,
        )
    )
    momenta = volumes[:, None] * conservative[:, 1:4]
    kinetic = 0.5 * float((momenta * primitive[:, 1:4]).sum())
    now = conserved(conservative, volumes, team)
    turning = np.cross(positions, momenta).sum(axis=0)
    if params.has_rings:
        now[2:4], turning[:] = 0.0, 0.0
    return Totals(
        mass=float(now[0]),
        momentum=now[1:4],
        angular_momentum=turning,
        kinetic=kinetic,
        internal=float(now[4]) - kinetic,
        work=state.work,
        dissipated=0.0,  # friction heats the gas
    )


def step_error(
    wrong: list[int],
    domain: Domain,
    primitive: Array,
    time: float,
    share: float,
    planar: bool,
    team: Team,
    ranks: Ranks,
) -> StepError:
    """Error of a state that is none.

    Parameters
    ----------
    wrong : list of int
        The row among nodes that are advanced, on the rank that has it.
    domain, primitive, planar, team, ranks
    time : float, s
        When the step began.
    share : float, 1
        The step over 1/Σ(|v·c| + a|c|).
    """
    rows = ranks.share(domain).inner[wrong].astype(np.int64)
    sided = sidedness(domain.cloud, domain.stencils, rows, planar, team)
    numbers = (domain.cloud.positions[rows], primitive[rows], sided[:, None])
    where = ranks.from_owner(np.hstack(numbers).ravel())
    sentence = failure(where[:3], where[3:8], time, share, float(where[8]))
    return StepError(sentence, where[:3])


def failure(place: Array, state: Array, time: float, share: float, sided: float) -> str:
    """Say that a state is none, and what is likely to help.

    Parameters
    ----------
    place : (3,) m
        Of the node.
    state : (5,) kg/m3, m/s, Pa
        Its state.
    time : float, s
        When the step began.
    share : float, 1
        The step over 1/Σ(|v·c| + a|c|).
    sided : float, 1
        Sidedness of its neighbours.
    """
    where = np.array2string(place, precision=4)
    cause = (
        f"density and pressure must stay above 0; the node at {where} m has {state[0]:.3g} kg/m3 "
        f"and {state[4]:.3g} Pa in the step from t = {time:.6g} s, of {share:.2f} of "
        "1/Σ(|v·c| + a|c|). "
    )
    if sided > UNEVEN:
        return cause + (
            f"Its neighbours lie mostly on one side (sidedness {sided:.2f}, at most {UNEVEN:g}). "
            "Leave neighbours out, or lower jitter."
        )
    if share > SAFE:
        return cause + f"Lower courant to {SAFE:g} or less."
    return cause + 'Refine the cloud there, say limiter = "minmod" or "van_albada", or order = 1.'
