"""How the error of a window goes on to the end of a run, from the run's own motion.

The changes of a state from window to window obey the same linear equations as a small error does,
as long as the laws of the motion do not depend on time: if y(n+1) = M y(n) + c, then
Δy(n+1) = M Δy(n). So an error that is a combination of the next changes of the state,

    e(n) = Σ w_k Δ^k y(n),    k = 1 ... DIFFERENCES,    Δy(n) = y(n+1) - y(n),

is the same combination of those at any later time, e(m) = Σ w_k Δ^k y(m): w₁ is a delay, the others
are errors of amplitude and shape. A state of d numbers needs d differences. What they cannot
express, such as a wrong total momentum or energy, is taken to stay, and a velocity to move its
position on: shifts of each position, and equal ones of all velocities or temperatures, are fitted
beside the differences, so that they are not taken for parts of these.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

import numpy as np

from quintet.coupler.coupling.exchange import Exchange
from quintet.coupler.coupling.judgement.time_error import Key
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.sums import dot, norm

DIFFERENCES = 4
INDEPENDENT = 1e-3  # of a difference: what the lower ones must leave of it
NOISE = 1e-12  # of the state: differences as small as this are rounding


def differences(states: Sequence[Array]) -> list[Array]:
    """Forward differences of order 1 to DIFFERENCES at the first of DIFFERENCES + 1 states."""
    rows, orders = [np.asarray(state) for state in states], []
    while len(rows) > 1:
        rows = [after - before for before, after in pairwise(rows)]
        orders.append(rows[0])
    return orders


def rest_of(error: Array, weights: Sequence[float], states: Sequence[Array]) -> Array:
    """What the weights leave of an error of a field, (n, ...)."""
    carried = sum(w * d for w, d in zip(weights, differences(states), strict=True))
    return np.asarray(error - carried)


def error_weights(
    exchange: Exchange,
    errors: Mapping[Key, Array],
    states: Sequence[Mapping[str, Fields]],
) -> list[float]:
    """Weights w_k of the combination of differences that is nearest to an error.

    Parameters
    ----------
    errors : mapping
        Error of each output at the end of a window, by component and field.
    states : sequence of mappings
        Outputs of all components at that end, and at the ends of the next DIFFERENCES windows.
    """
    keys = [place for place in errors if _is_state(exchange, *place)]
    scales = {key: _scale([state[key[0]][key[1]] for state in states]) for key in keys}
    keys = [key for key in keys if scales[key] > 0.0]
    if not keys:
        return [0.0] * DIFFERENCES

    def flat(fields: Mapping[Key, Array]) -> Array:
        return np.concatenate([fields[key].ravel() / scales[key] for key in keys])

    rows = [flat({(name, key): state[name][key] for name, key in keys}) for state in states]
    shifts = [flat(shift) for shift in _equal_shifts(exchange, keys, states[0])]
    vectors = [*differences(rows), *shifts]
    return nearest(flat(errors), vectors, NOISE * norm(rows[0]))[:DIFFERENCES]


def _equal_shifts(
    exchange: Exchange, keys: Sequence[Key], state: Mapping[str, Fields]
) -> Iterator[dict[Key, Array]]:
    """Yield shifts by one unit along each axis: of each position, of all velocities or others."""
    groups: dict[object, list[Key]] = {}
    for key in keys:
        output = exchange.output(*key)
        group = key if output.rate else (output.unit, output.shape)
        groups.setdefault(group, []).append(key)
    for members in groups.values():
        shape = exchange.output(*members[0]).shape
        for direction in np.eye(math.prod(shape)):
            shift = {key: np.zeros_like(state[key[0]][key[1]]) for key in keys}
            for key in members:
                shift[key] += direction.reshape(shape)
            yield shift


def _is_state(exchange: Exchange, name: str, key: str) -> bool:
    """Whether an output is an instant of a kind whose differences add up."""
    field = exchange.gives[name][key]
    return field.centring == "instant" and field.kind == "value"


def _scale(states: Sequence[Array]) -> float:
    """Largest change of a field from window to window, as its root mean square."""
    changes = [norm(after - before) for before, after in pairwise(states)]
    return max(changes) / max(1.0, float(states[0].size)) ** 0.5


def nearest(target: Array, vectors: Sequence[Array], noise: float = 0.0) -> list[float]:
    """Weights of the combination of vectors that is nearest to a target.

    A vector that depends on those before it, or leaves no more than `noise` of itself, gets 0.
    """
    basis: list[Array] = []
    parts: list[list[float]] = []  # of each basis vector, in terms of the vectors
    for number, vector in enumerate(vectors):
        left, of_vectors = vector, [float(at == number) for at in range(len(vectors))]
        for _ in range(2):  # twice is enough
            for unit, part in zip(basis, parts, strict=True):
                share = dot(unit, left)
                left = left - share * unit
                of_vectors = [a - share * b for a, b in zip(of_vectors, part, strict=True)]
        size = norm(left)
        if size > max(INDEPENDENT * norm(vector), noise):
            basis.append(left / size)
            parts.append([a / size for a in of_vectors])
    weights = [0.0] * len(vectors)
    for unit, part in zip(basis, parts, strict=True):
        share = dot(unit, target)
        weights = [a + share * b for a, b in zip(weights, part, strict=True)]
    return weights
