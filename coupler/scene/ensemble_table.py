"""``[ensemble.NAME]``: what is uncertain in a scene, and how it is distributed.

    [ensemble.friction]
    keys = ["components.cubes.pairs.0.friction", "components.cubes.pairs.1.friction"]
    normal = [0.15, 0.02]                 # mean, standard deviation

    [ensemble.position]
    keys = ["components.cubes.bodies.2.lowest.0", "components.cubes.bodies.2.highest.0"]
    uniform = [-1e-3, 1e-3]
    added = true

Every run of an ensemble draws one number for each of these tables, from a seed and the number of
the run alone: the first 8 runs of 32 are the 8 runs of an ensemble of 8.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from quintet.coupler.scene.varied_tables import MakeVariant, Table, value_at
from quintet.interfaces.params import Number, parameters, read, shown


@parameters
class PerturbationTable:
    """What is uncertain in a scene: one random number for one or several keys.

    Parameters
    ----------
    keys
        Paths of the numbers in the scene, as in ``--set``; all take the same number of a run.
    uniform : `unit` of the keys
        Lower and upper end of a uniform distribution; this or `normal`.
    normal : `unit` of the keys
        Mean and standard deviation of a normal distribution.
    added
        Whether the number is added to that of the scene; else it stands in its place.
    source
        Where the distribution is from.
    """

    keys: tuple[str, ...]
    uniform: tuple[Number, Number] | None = None
    normal: tuple[Number, Number] | None = None
    added: bool = False
    source: str = ""

    def __post_init__(self) -> None:
        wrong = [sentence for is_wrong, sentence in self._rules() if is_wrong]
        if wrong:
            raise ValueError(" ".join(wrong))

    def _rules(self) -> list[tuple[bool, str]]:
        uniform, normal = self.uniform, self.normal
        return [
            (not self.keys, "keys must name a number of the scene or more; found none. Add one."),
            (
                len(set(self.keys)) < len(self.keys),
                f"keys must differ; found {shown(list(self.keys))}. Remove one.",
            ),
            (
                (uniform is None) == (normal is None),
                "it must have one distribution; give either uniform or normal.",
            ),
            (
                uniform is not None and not uniform[0] < uniform[1],
                f"uniform must go from its lower to its upper end; found {uniform}. Exchange them.",
            ),
            (
                normal is not None and not normal[1] > 0.0,
                f"normal needs a standard deviation above 0; found {normal}. Correct it.",
            ),
        ]

    @property
    def middle(self) -> float:
        """Mean of the distribution."""
        if self.uniform is not None:
            return 0.5 * (self.uniform[0] + self.uniform[1])
        assert self.normal is not None
        return self.normal[0]

    def draw(self, random: np.random.Generator) -> float:
        """Draw one number."""
        if self.uniform is not None:
            return float(random.uniform(*self.uniform))
        assert self.normal is not None
        return float(random.normal(*self.normal))


@dataclass(frozen=True, slots=True)
class Perturbation:
    """One perturbation, checked."""

    name: str
    table: PerturbationTable
    base: tuple[float, ...]  # what is added to, one for each key; 0 where the number replaces

    def settings(self, number: float) -> dict[str, float]:
        """Settings by dotted path, of a number that was drawn."""
        pairs = zip(self.table.keys, self.base, strict=True)
        return {key: base + number for key, base in pairs}


def read_perturbations(
    tables: Any, scene: Table, make_variant: MakeVariant
) -> tuple[list[Perturbation], list[str]]:
    """Check what is uncertain in a scene; return it, and every mistake.

    The scene must accept the mean of every distribution, all of them at once.
    """
    if not isinstance(tables, dict):
        return [], [f"ensemble must be tables; found {shown(tables)}. Write [ensemble.NAME]."]
    perturbations: list[Perturbation] = []
    mistakes: list[str] = []
    for name, table in tables.items():
        checked, wrong = read(PerturbationTable, table, f"ensemble.{name}")
        if checked is not None:
            base, lacking = _base(checked, scene)
            wrong += [f"ensemble.{name}.keys: {mistake}" for mistake in lacking]
            perturbations.append(Perturbation(name, checked, base))
        mistakes += wrong
    keys = [key for perturbation in perturbations for key in perturbation.table.keys]
    mistakes += [
        f"ensemble: a key must be in one table; found {key} in {keys.count(key)}. Remove it."
        for key in dict.fromkeys(keys)
        if keys.count(key) > 1
    ]
    if perturbations and not mistakes:
        middle: Table = {}
        for perturbation in perturbations:
            middle |= perturbation.settings(perturbation.table.middle)
        mistakes += [f"ensemble, at its means: {wrong}" for wrong in make_variant(middle)[1]]
    return perturbations, mistakes


def _base(table: PerturbationTable, scene: Table) -> tuple[tuple[float, ...], list[str]]:
    """Numbers of the scene that are added to, and what is none."""
    if not table.added:
        return (0.0,) * len(table.keys), []
    base, mistakes = [], []
    for key in table.keys:
        value, wrong = value_at(scene, key)
        if not wrong and (isinstance(value, bool) or not isinstance(value, (int, float))):
            wrong = f"{key} must be a number; found {shown(value)}. Name one."
        if wrong:
            mistakes.append(wrong)
        else:
            base.append(float(value))
    return tuple(base), mistakes


def draw_settings(
    perturbations: Sequence[Perturbation], seed: int, runs: int
) -> list[dict[str, float]]:
    """Settings of each run of an ensemble, by dotted path.

    The numbers of a run depend on the seed, its own number and the order of the tables alone.
    """
    drawn: list[dict[str, float]] = []
    for run in range(runs):
        random = np.random.default_rng([seed, run])
        settings: dict[str, float] = {}
        for perturbation in perturbations:
            settings |= perturbation.settings(perturbation.table.draw(random))
        drawn.append(settings)
    return drawn
