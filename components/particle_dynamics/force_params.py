"""Parameters of the forces between pairs of mass points."""

import math
from typing import Annotated, Literal

from pydantic import Field

from quintet.interfaces.params import NotNegative, Positive, parameters

CutOff = Annotated[float, Field(ge=0.5, lt=1.0)]
HIGHEST_EXPONENT = 12


@parameters
class SevenRootForce:
    """F = c Π(x - x_i) e(x) STEP(x, 2s, 1, 2, 0), with x = r/a; positive is attraction.

    Stable roots stand at the neighbours of the lattice: 1, √2, √3, 2. Arinchev's envelope e is
    (x - 1)^p, ``power``; with p above 0 the bonds to the nearest have no linear stiffness.

    Parameters
    ----------
    envelope
        e(x): x^p (ratio) or, to the letter of the paper, (x - 1)^p (power).
    exponent : 1
        p: a whole number for ratio, an even one for power.
    unstable_roots : 1
        x₂, x₄, x₆, between the stable ones.
    cut_off : 1
        s: the cut-off begins at 2s spacings and ends at 2.
    top_frequency : Hz
        Highest frequency of the lattice with its frozen points (above 2000 points: of the infinite
        lattice), from which c follows; this or `amplitude`.
    amplitude : N
        c: of power A a^(7+p), of ratio A a^7.
    """

    envelope: Literal["ratio", "power"] = "ratio"
    exponent: NotNegative = 6.0
    unstable_roots: tuple[Positive, Positive, Positive] = (
        0.5 * (1.0 + math.sqrt(2.0)),
        0.5 * (math.sqrt(2.0) + math.sqrt(3.0)),
        0.5 * (math.sqrt(3.0) + 2.0),
    )
    cut_off: CutOff = 0.9
    top_frequency: Positive | None = None
    amplitude: Positive | None = None

    def __post_init__(self) -> None:
        p = self.exponent
        if p != math.floor(p) or p > HIGHEST_EXPONENT:
            raise ValueError(
                f"seven_roots: exponent must be whole and at most {HIGHEST_EXPONENT}; found {p:g}: "
                "a power with a fraction has no value where points are nearer than a spacing. "
                "Take 0, 2, 4 or 6."
            )
        if self.envelope == "power" and p % 2 == 1:
            raise ValueError(
                f"seven_roots: exponent of the envelope power must be even; found {p:g}: with an "
                "odd one the force does not change its sign at r = a, so that nothing brings a "
                "point back. Take 0 or 2, or the envelope ratio."
            )
        if (self.top_frequency is None) == (self.amplitude is None):
            raise ValueError(
                "seven_roots: its strength must be given once; give either top_frequency or "
                "amplitude."
            )
        first, second, third = self.unstable_roots
        inside = 1.0 < first < math.sqrt(2.0) < second < math.sqrt(3.0) < third < 2.0
        if not inside:
            raise ValueError(
                "seven_roots: unstable_roots must stand between 1, √2, √3 and 2; found "
                f"{self.unstable_roots}. Correct them."
            )


@parameters
class Damping:
    """A force δ ṙ along pairs.

    Parameters
    ----------
    coefficient : N s/m
        δ.
    range
        Which pairs: all, at any distance, as the paper's formula has it (up to 2000 points, open
        sides); those within two spacings (cut-off); or with the weight of the force's STEP (step).
    cut_off : 1
        s of that weight.
    """

    coefficient: NotNegative
    range: Literal["all", "cut-off", "step"] = "cut-off"
    cut_off: CutOff = 0.9
