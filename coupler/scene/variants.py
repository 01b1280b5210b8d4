"""Variants of a scene: its refinements, limits and scans, checked with the scene."""

from collections.abc import Callable
from copy import deepcopy
from dataclasses import dataclass, field

from quintet.coupler.scene.overrides import put
from quintet.coupler.scene.scan_table import Scan, read_scans
from quintet.coupler.scene.stability_checks import Scope, read_limits
from quintet.coupler.scene.stability_table import Limit
from quintet.coupler.scene.study_table import Refinement, read_refinements
from quintet.coupler.scene.varied_tables import MakeVariant, Table
from quintet.interfaces.errors import SceneError

VARIED = ("study", "stability", "scan")


@dataclass(frozen=True, slots=True)
class Variants:
    """Refinements, stability limits and scans of a scene."""

    study: list[Refinement] = field(default_factory=list)
    stability: list[Limit] = field(default_factory=list)
    scan: list[Scan] = field(default_factory=list)


def read_variants(
    tables: dict[str, list[Table]],
    make_variant: MakeVariant,
    scope: Scope | None,
    inherits_scans: bool = False,
) -> tuple[Variants, list[str]]:
    """Check refinements, limits and scans; a scene with mistakes has no scope."""
    refinements, wrong = read_refinements(tables["study"], make_variant)
    limits, wrong_limits = read_limits(tables["stability"], make_variant, scope)
    expected = scope.expected if scope else None
    scans, wrong_scans = read_scans(tables["scan"], make_variant, expected, inherits_scans)
    return Variants(refinements, limits, scans), wrong + wrong_limits + wrong_scans


def variant_maker(table: Table, check: Callable[[Table], object] | None) -> MakeVariant:
    """Return a function that applies settings to a scene and checks it, or their paths alone."""

    def make_variant(settings: Table) -> tuple[Table, list[str]]:
        plain = deepcopy({key: value for key, value in table.items() if key not in VARIED})
        mistakes = [m for path, value in settings.items() for m in put(plain, path, value)]
        if check is None or mistakes:
            return plain, mistakes
        try:
            check(plain)
        except SceneError as error:
            # The refinement or limit is named before the mistake: no file name is needed.
            mistakes = [mistake.partition(": ")[2] for mistake in error.mistakes]
        return plain, mistakes

    return make_variant
