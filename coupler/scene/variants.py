"""Variants of a scene: its refinements and stability limits, checked with the scene."""

from collections.abc import Callable
from copy import deepcopy

from quintet.coupler.scene.overrides import put
from quintet.coupler.scene.stability_table import Limit, Scope, read_limits
from quintet.coupler.scene.study_table import MakeVariant, Refinement, Table, read_refinements
from quintet.interfaces.errors import SceneError

TABLES = ("study", "stability")


def read_variants(
    study: list[Table], stability: list[Table], make_variant: MakeVariant, scope: Scope | None
) -> tuple[list[Refinement], list[Limit], list[str]]:
    """Check refinements and stability limits; a scene with mistakes has no scope."""
    refinements, wrong = read_refinements(study, make_variant)
    limits, also_wrong = read_limits(stability, make_variant, scope)
    return refinements, limits, wrong + also_wrong


def variant_maker(table: Table, check: Callable[[Table], object] | None) -> MakeVariant:
    """Return a function that applies settings to a scene and checks it, or their paths alone."""

    def make_variant(settings: Table) -> tuple[Table, list[str]]:
        plain = deepcopy({key: value for key, value in table.items() if key not in TABLES})
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
