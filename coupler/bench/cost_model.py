"""Cost model of a component of several MPI ranks: what a step takes on any number of them.

Of N items on P ranks, n = N/P each, in the time of the rank with most of each:

    t(N, P) = i (a n + c h + f) + m L + h / B + k L log2 P + G / B

with the imbalance i of compute; m messages of latency L; h bytes of halo at bandwidth B; k
collective operations, each a tree of log2 P messages; and G bytes of other ranks' rows that
collectives bring to a rank. The seconds a (an item), c (a byte of halo: it is packed and unpacked,
and pairs across a border are computed on both sides) and f (a step) are fitted to measured compute.
m, h, k and G are counted. They are extrapolated as follows.

A cube of N items in d dimensions is halved along its axes in turn, p_1 p_2 ... p_d = P parts. The
inner rank has min(2, p_j - 1) faces across axis j, each of n^((d-1)/d) p_j / P^(1/d) items:
h is as their sum, and m as the parts that it touches, the product of min(3, p_j), less 1. k is
constant, and G = g N (P - 1) / P.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from typing import NamedTuple

import numpy as np

from quintet.interfaces.component import Array


class Network(NamedTuple):
    """What a message between two ranks takes."""

    latency: float  # s
    bandwidth: float  # bytes/s


@dataclass(frozen=True, slots=True)
class Measurement:
    """A step of a component on some ranks; counts are those of the rank with most, per step.

    Parameters
    ----------
    items : int
        Of all ranks.
    ranks : int
    compute : float, s
        Processor time of a rank without waiting, mean over the ranks.
    imbalance : float
        Largest over mean compute of the ranks.
    messages, halo : float
        Sent to single ranks, and the bytes in them.
    collectives : float
        Operations of all ranks.
    gathered : float
        Bytes of other ranks' rows that came by these.
    clock : float, s
        By the clock.
    """

    items: int
    ranks: int
    compute: float
    imbalance: float = 1.0
    messages: float = 0.0
    halo: float = 0.0
    collectives: float = 0.0
    gathered: float = 0.0
    clock: float = math.nan


class Terms(NamedTuple):
    """What a step takes [s]."""

    compute: float
    latency: float  # of messages
    halo: float
    collectives: float  # latency of these
    gathered: float

    @property
    def total(self) -> float:
        """All of it [s]."""
        return sum(self)


@dataclass(frozen=True, slots=True)
class CostModel:
    """Fitted and counted numbers of the model.

    Parameters
    ----------
    per_item : float, s
    per_halo_byte : float, s
    per_step : float, s
    exchanges : float
        Messages a step to each neighbour.
    halo : float
        Bytes a step through a face of one item.
    collectives : float
        A step.
    gathered : float
        Bytes a step of each item of other ranks.
    imbalance : float
        On more ranks than were measured: that on most of these.
    measured_ranks : int
        Most that were measured.
    dimensions : int
        In which ranks part space.
    residuals : mapping of float
        Root mean square of model over measurement, less 1: of compute, halo, messages, collectives,
        and gathered.
    free : int
        Measurements of compute, less numbers fitted to them.
    """

    per_item: float
    per_halo_byte: float = 0.0
    per_step: float = 0.0
    exchanges: float = 0.0
    halo: float = 0.0
    collectives: float = 0.0
    gathered: float = 0.0
    imbalance: float = 1.0
    measured_ranks: int = 1
    dimensions: int = 3
    residuals: Mapping[str, float] = field(default_factory=dict)
    free: int = 0


def parts(ranks: int, dimensions: int) -> list[float]:
    """Parts along each axis, halved in turn; between powers of two the last one is no whole."""
    halvings = math.log2(ranks)
    whole = halvings // dimensions
    rest = halvings - dimensions * whole
    return [2.0 ** (whole + min(max(rest - axis, 0.0), 1.0)) for axis in range(dimensions)]


def faces(items: float, ranks: int, dimensions: int) -> float:
    """Items on all faces of an inner rank of `items` of its own."""
    along = parts(ranks, dimensions)
    shape = sum(min(2.0, p - 1.0) * p for p in along) / ranks ** (1.0 / dimensions)
    return float(shape * items ** (1.0 - 1.0 / dimensions))


def neighbours(ranks: int, dimensions: int) -> float:
    """Parts that an inner one touches, at corners too."""
    return math.prod(min(3.0, p) for p in parts(ranks, dimensions)) - 1.0


def fit(measurements: Sequence[Measurement], dimensions: int = 3) -> CostModel:
    """Fit the model to steps of components that differ in items and ranks alone.

    Time that a step takes whatever its items (f) is fitted only where there are several numbers of
    items, as those of one number hardly show it.

    Raises
    ------
    ValueError
        If there are no three measurements, or all are on one number of ranks.
    """
    if len(measurements) < 3 or len({m.ranks for m in measurements}) < 2:
        raise ValueError("a cost model needs three measurements, on several numbers of ranks")
    sizes = len({m.items for m in measurements})
    columns = [
        [m.items / m.ranks, m.halo, 1.0 if sizes > 1 else 0.0] for m in measurements
    ]  # (k, 3)
    times = np.array([m.compute for m in measurements])
    a, c, f = not_negative(np.array(columns) / times[:, None])
    several = [m for m in measurements if m.ranks > 1]
    most = max(several, key=lambda m: (m.ranks, m.items))

    def counted(name: str, law: Callable[[Measurement], float]) -> tuple[float, float]:
        pairs = [(law(m), getattr(m, name)) for m in several]
        return _factor([(x, y) for x, y in pairs if y > 0.0])

    halo, halo_off = counted("halo", lambda m: faces(m.items / m.ranks, m.ranks, dimensions))
    exchanges, messages_off = counted("messages", lambda m: neighbours(m.ranks, dimensions))
    collectives, collectives_off = counted("collectives", lambda _: 1.0)
    gathered, gathered_off = counted("gathered", lambda m: m.items * (1.0 - 1.0 / m.ranks))
    off = np.array(columns) @ (a, c, f) / times - 1.0
    return CostModel(
        a,
        c,
        f,
        exchanges,
        halo,
        collectives,
        gathered,
        most.imbalance,
        most.ranks,
        dimensions,
        {
            "compute": float(np.sqrt(np.mean(off**2))),
            "halo": halo_off,
            "messages": messages_off,
            "collectives": collectives_off,
            "gathered": gathered_off,
        },
        len(times) - int(np.count_nonzero((a, c, f))),
    )


def not_negative(columns: Array) -> tuple[float, float, float]:
    """Numbers (3,), none below 0, whose sums of columns (k, 3) are nearest to 1.

    The best of all choices of columns whose own least squares are not negative.
    """
    best, distance = np.zeros(3), math.inf
    used = [j for j in range(3) if columns[:, j].any()]
    for count in range(1, len(used) + 1):
        for choice in map(list, combinations(used, count)):
            scale = np.abs(columns[:, choice]).max(axis=0)
            numbers = np.linalg.lstsq(columns[:, choice] / scale, np.ones(len(columns)))[0] / scale
            away = float(np.sum((columns[:, choice] @ numbers - 1.0) ** 2))
            if (numbers >= 0.0).all() and away < distance:
                best, distance = np.zeros(3), away
                best[choice] = numbers
    a, c, f = best.tolist()
    return a, c, f


def _factor(pairs: Sequence[tuple[float, float]]) -> tuple[float, float]:
    """Factor of the x that is nearest to the y, relative to these, and what is left (rms)."""
    if not pairs:
        return 0.0, 0.0
    ratios = np.array([x / y for x, y in pairs])
    factor = float(ratios.sum() / (ratios**2).sum())
    return factor, float(np.sqrt(np.mean((factor * ratios - 1.0) ** 2)))


def of_model(
    model: CostModel, network: Network, items: float, ranks: int, imbalance: float | None = None
) -> Terms:
    """Time of a step by the model."""
    each = items / ranks
    halo = model.halo * faces(each, ranks, model.dimensions)
    messages = model.exchanges * neighbours(ranks, model.dimensions)
    uneven = model.imbalance if imbalance is None else imbalance
    compute = model.per_item * each + model.per_halo_byte * halo + model.per_step
    return Terms(
        compute * (uneven if ranks > 1 else 1.0),
        messages * network.latency,
        halo / network.bandwidth,
        (model.collectives * math.log2(ranks) * network.latency) if ranks > 1 else 0.0,
        model.gathered * items * (1.0 - 1.0 / ranks) / network.bandwidth,
    )


def of_measurement(measured: Measurement, network: Network) -> Terms:
    """Time of a step of measured compute and counted messages on a network."""
    return Terms(
        measured.compute * measured.imbalance,
        measured.messages * network.latency,
        measured.halo / network.bandwidth,
        measured.collectives * math.log2(measured.ranks) * network.latency,
        measured.gathered / network.bandwidth,
    )


def strong_efficiency(model: CostModel, network: Network, items: float, ranks: int) -> float:
    """Time on one rank over P times that on P, of the same items."""
    alone = of_model(model, network, items, 1).total
    return alone / (ranks * of_model(model, network, items, ranks).total)


def weak_efficiency(model: CostModel, network: Network, items: float, ranks: int) -> float:
    """Time of some items on one rank over that of as many on each of P."""
    alone = of_model(model, network, items, 1).total
    return alone / of_model(model, network, items * ranks, ranks).total


def of_run(
    model: CostModel, network: Network, items: float, step: float, measured: int, ranks: int
) -> Terms:
    """Time of a step of a run on `ranks`, from that `step` [s] that it took on `measured` ranks.

    Compute of the model is scaled so that it has that time there: a run may have other physics than
    the benchmark. Messages are those of the model.

    Raises
    ------
    ValueError
        If messages alone would have taken longer than the measured step.
    """
    measured_cost = of_model(model, network, items, measured)
    rest = step - (measured_cost.total - measured_cost.compute)
    if rest <= 0.0:
        raise ValueError(
            f"a step must take longer than its messages, {1e3 * (step - rest):.3g} ms by the model"
        )
    cost = of_model(model, network, items, ranks)
    return cost._replace(compute=cost.compute * rest / measured_cost.compute)
