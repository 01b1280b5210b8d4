"""Shares of an error: what each kind of refinement contributes, and what none of them reduces.

With independent contributions, value - reference = Σ C_k h_k^p_k + rest. The terms are those of
each kind's own refinements, evaluated at the sizes of one run; the rest is the error of the model,
of the reference, and of what was not refined.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from quintet.coupler.measures.convergence import Limit, Order

REST = "rest"


@dataclass(frozen=True, slots=True)
class Trend:
    """How a value or its error falls with the size of one kind; None where it is not known."""

    limit: Limit | None
    order: Order | None

    def at(self, size: float, error: float | None) -> float | None:
        """Contribution at a size, with its sign; the order alone gives it that of the error."""
        if self.limit is not None:
            return self.limit.at(size)
        if self.order is None or self.order.order <= 0.0:
            return None
        return self.order.at(size) if error is None or error >= 0.0 else -self.order.at(size)


def shares(
    trends: Mapping[str, Trend], sizes: Mapping[str, float], error: float | None
) -> dict[str, float | None]:
    """Split the error of one run.

    Parameters
    ----------
    trends : mapping
        By kind.
    sizes : mapping
        By kind: those of the run.
    error : float or None
        Value - reference of the run; None where there is no reference: then there is no rest.

    Returns
    -------
    dict
        By kind, and for the rest: the share, 0 to 1, of the sum of all magnitudes; None for a kind
        whose contribution is not known, which is then part of the rest.
    """
    parts = {
        kind: trend.at(sizes[kind], error) if kind in sizes else None
        for kind, trend in trends.items()
    }
    known = {kind: part for kind, part in parts.items() if part is not None}
    if error is not None:
        known[REST] = error - sum(known.values())
    total = sum(map(abs, known.values()))
    return {
        kind: abs(known[kind]) / total if kind in known and total > 0.0 else None
        for kind in (*trends, *([REST] if error is not None else []))
    }
