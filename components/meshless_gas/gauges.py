"""What is read at places: states of the nearest nodes, and fronts along lines."""

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.boundaries import Gas
from quintet.components.meshless_gas.build import Domain
from quintet.components.meshless_gas.clouds.cloud import Cloud, Whole
from quintet.components.meshless_gas.diagnostics import mach, temperature
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.parts import Part, Reader
from quintet.components.meshless_gas.readings import Front
from quintet.components.shared.search.nearest import nearest, nearest_rows
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.errors import SceneError

NEAR = 4  # nodes between which is interpolated
PER_SPACING = 4.0  # places on a line
Rows = NDArray[np.int64]


class SampledLine(NamedTuple):
    """Places along a line, and the nodes around each."""

    distances: Array  # (s,) m, from where it begins
    rows: Rows  # (s, NEAR)
    weights: Array  # (s, NEAR) 1, by the inverse squares of the distances
    begin: Array  # (3,) m
    direction: Array  # (3,) 1
    column: int  # of the primitive states
    level: float


class Gauges(Part):
    """Probes, and fronts along lines."""

    def __init__(self, params: MeshlessGasParams, domain: Domain, team: Team) -> None:
        ends = [end for front in params.fronts for end in (front.begin, front.end)]
        refuse_far(domain, (*params.probes, *ends))
        self.gas, self.cloud = params.gas, domain.cloud
        self.probed = nearest_rows(domain.cloud.positions[: domain.cloud.nodes], params.probes)
        self.lines = [line(domain.cloud, front, team) for front in params.fronts]

    def reads(self) -> Whole:
        """Nodes at the places."""
        lines = (sampled.rows.ravel() for sampled in self.lines)
        return np.concatenate([self.probed, *lines]).astype(np.int32)

    def renumber(self, local: Whole, domain: Domain) -> None:
        """Take the rows of nodes on this rank."""
        self.cloud, self.probed = domain.cloud, local[self.probed].astype(np.int64)
        self.lines = [
            sampled._replace(rows=local[sampled.rows].astype(np.int64)) for sampled in self.lines
        ]

    def readers(self, primitive: Array) -> Mapping[str, Reader]:
        """Readers of the ports `probes` and `fronts`."""
        return {
            "probes": lambda: probes(self.probed, self.cloud, primitive, self.gas),
            "fronts": lambda: fronts(self.lines, primitive),
        }


def refuse_far(domain: Domain, places: Sequence[Sequence[float]]) -> None:
    """Refuse places that lie farther from the nodes than these from each other."""
    cloud, near = domain.cloud, domain.stencils.neighbours
    rows = nearest_rows(cloud.positions[: cloud.nodes], places)
    for place, row in zip(places, rows, strict=True):
        arms = cloud.positions[near[row]] - cloud.positions[row]
        arm = cloud.positions[row] - np.array(place)
        if cloud_is_plane(cloud):
            arm[1] = 0.0
        away, reach = np.linalg.norm(arm), np.linalg.norm(arms, axis=1).max()
        if away > reach:
            raise SceneError(
                f"probes and fronts must lie among the nodes; {list(place)} m is {away:.3g} m from "
                f"the nearest, whose neighbours are at most {reach:.3g} m away. Move it."
            )


def cloud_is_plane(cloud: Cloud) -> bool:
    """Whether all nodes but ghosts have one y."""
    return float(np.ptp(cloud.positions[: cloud.nodes, 1])) == 0.0


def line(cloud: Cloud, front: Front, team: Team) -> SampledLine:
    """Find the nodes around the places of a line."""
    begin, end = np.array(front.begin), np.array(front.end)
    length = float(np.linalg.norm(end - begin))
    among = np.arange(cloud.nodes)
    finest = float(cloud.spacing[: cloud.nodes].min())
    count = max(2, min(20_000, round(PER_SPACING * length / finest)))
    distances = np.linspace(0.0, length, count)
    direction = (end - begin) / length
    targets = begin + distances[:, None] * direction
    rows, squares = nearest(cloud.positions, among, targets, NEAR, team)
    weights = 1.0 / (squares + 1e-12 * finest**2)
    weights /= weights.sum(axis=1, keepdims=True)
    column = {"density": 0, "pressure": 4}[front.field]
    return SampledLine(distances, rows, weights, begin, direction, column, front.level)


def crossing(sampled: SampledLine, primitive: Array) -> float:
    """Distance [m] at which the level is first passed; minus the line's length if it is not."""
    values = (sampled.weights * primitive[sampled.rows, sampled.column]).sum(axis=1)
    above = values > sampled.level
    turns = np.flatnonzero(above[1:] != above[:-1])
    if not len(turns):
        return -float(sampled.distances[-1])
    k = int(turns[0])
    share = (sampled.level - values[k]) / (values[k + 1] - values[k])
    return float(sampled.distances[k] + share * (sampled.distances[k + 1] - sampled.distances[k]))


def fronts(lines: Sequence[SampledLine], primitive: Array) -> Fields:
    """Fields of the port `fronts`."""
    distances = np.array([crossing(sampled, primitive) for sampled in lines])
    met = distances >= 0.0
    places = np.array([a.begin + d * a.direction for a, d in zip(lines, distances, strict=True)])
    return {
        "fronts.position": places,
        "fronts.distance": distances,
        "fronts.angle": np.array(
            [angle(places[: k + 1]) if met[: k + 1].all() else -math.pi for k in range(len(met))]
        ),
        "fronts.found": met.astype(np.float64),
    }


def angle(places: Array) -> float:
    """Angle [rad] to x of the straight line through places (k, 3) m, of least squares in z."""
    x, z = (places[:, d] - places[:, d].mean() for d in (0, 2))
    across = float((x * x).sum())
    return float(np.arctan2((x * z).sum(), across)) if len(places) > 1 else 0.0


def probes(rows: Rows, cloud: Cloud, primitive: Array, gas: Gas) -> Fields:
    """Fields of the port `probes`."""
    states = primitive[rows]
    return {
        "probes.position": cloud.positions[rows],
        "probes.velocity": states[:, 1:4].copy(),
        "probes.density": states[:, 0].copy(),
        "probes.pressure": states[:, 4].copy(),
        "probes.temperature": temperature(states, gas),
        "probes.mach": mach(states, gas),
    }
