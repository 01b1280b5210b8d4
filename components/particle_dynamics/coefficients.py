"""Coefficients of the laws of one pair, for compiled loops and for plans alike."""

from typing import NamedTuple

from quintet.interfaces.component import Array

MIDDLE = 1.5  # spacings, about which potentials are expanded: cancellation is least there


class SevenRoots(NamedTuple):
    """F = c Π(x - x_i) (x - b)^p STEP(x, 2s, 1, 2, 0) with x = r/a (Arinchev, formula 3)."""

    strength: float  # N, c = A a^(7+p), or A a^7 of the ratio envelope
    per_metre: float  # 1/a
    roots: tuple[float, ...]  # seven, of x: stable ones at 1, √2, √3, 2
    base: float  # b: 1 of the literal envelope, 0 of the ratio (r/a)^p
    factors: tuple[float, ...]  # p ones: how many is known to the compiler
    begin: float  # 2s, where the cut-off begins
    per_width: float  # 1/(2 - 2s)
    cutoff2: float  # m2
    inner: Array  # (m,) of the potential over c a, in powers of x - 1.5: before the cut-off begins
    outer: Array  # (m,) and from there to 2


class ForceTable(NamedTuple):
    """A force that is linear between equal steps of distance, and constant before the first."""

    first: float  # m
    per_metre: float  # 1/m, of its steps
    force: Array  # (n,) N
    energy: Array  # (n,) J, integral of the force, 0 at the last
    cutoff2: float  # m2


class PairDamping(NamedTuple):
    """δ ṙ along each pair, times a step that falls from 1 to 0."""

    coefficient: float  # N s/m, δ
    per_metre: float  # 1/a
    begin: float  # spacings, where the step begins
    per_width: float  # 1/spacings
