"""Scaling of residuals: fields of different units made comparable before they enter one norm.

Each field of the interface residual is divided by a running norm of its own residuals (the
residual preconditioner of Mehl et al. 2016, Comput. Math. Appl. 71, 869, and of preCICE), so that
newtons do not outvote metres. Impulses enter as rates, so that windows of uneven length compare.
"""

from collections.abc import Callable, Mapping

import numpy as np

from quintet.interfaces.component import Array
from quintet.interfaces.sums import norm

Key = tuple[str, str]  # component that takes a field, "port.field"
Guess = Mapping[Key, Array]  # impulses as integrals over the window, as links carry them
FORGET = 0.5  # of a field's scale from window to window, where its residuals are smaller


class ResidualScaling:
    """Guesses as vectors of rates, and the weight of each of their numbers."""

    def __init__(self, is_impulse: Callable[[str, str], bool]) -> None:
        self.is_impulse = is_impulse
        self.length = 1.0  # s, the window
        self.sizes = np.zeros(0)  # (fields,) running norm of each field's residual
        self._first = True  # residual of this window

    def begin_window(self, length: float) -> None:
        """Begin a window of a length [s]; its first residual sets the scales for all of it."""
        self.length, self._first = length, True

    def vector(self, fields: Guess) -> Array:
        """All fields one after the other, as rates (n,)."""
        parts = [(fields[key] / self.span(key)).reshape(-1) for key in sorted(fields)]
        return np.concatenate(parts) if parts else np.zeros(0)

    def fields(self, vector: Array, like: Guess) -> dict[Key, Array]:
        """A vector of rates as fields, in the order and the shapes of others."""
        ends = np.cumsum([like[key].size for key in sorted(like)])
        split = dict(zip(sorted(like), np.split(vector, ends[:-1]), strict=True)) if like else {}
        return {key: self.span(key) * split[key].reshape(like[key].shape) for key in like}

    def span(self, key: Key) -> float:
        """What a rate is multiplied with: the window's length [s] for an impulse, else 1."""
        return self.length if self.is_impulse(*key) else 1.0

    def weights(self, residual: Array, like: Guess, allowed: Mapping[Key, float]) -> Array:
        """Weight of each number of a residual (n,), in 1 / unit of its field's rate.

        No scale is below what convergence allows: a field that has long converged would
        otherwise be ruled by its rounding, and rule the others.
        """
        keys = sorted(like)
        counts = [like[key].size for key in keys]
        parts = np.split(residual, np.cumsum(counts)[:-1]) if keys else []
        norms = np.array([norm(part) for part in parts])
        if self._first:
            floors = np.array([allowed[key] for key in keys])
            former = FORGET * self.sizes if self.sizes.size else np.zeros(len(keys))
            self.sizes = np.maximum(np.maximum(norms, floors), former)
            self._first = False
        else:  # a field may have agreed in the first, and lack much when others have moved
            self.sizes = np.maximum(self.sizes, norms)
        return np.repeat(1.0 / np.where(self.sizes > 0.0, self.sizes, 1.0), counts)
