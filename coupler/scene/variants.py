"""A scene under other settings than its own: its ladder and its limits, checked with the scene."""

from collections.abc import Callable
from copy import deepcopy

from quintet.coupler.scene.overrides import put
from quintet.coupler.scene.stability_table import Limit, Scope, read_limits
from quintet.coupler.scene.study_table import Rung, Table, Trial, read_rungs
from quintet.interfaces.errors import SceneError

TABLES = ("study", "stability")


def read_driven(
    study: list[Table], stability: list[Table], trial: Trial, scope: Scope | None
) -> tuple[list[Rung], list[Limit], list[str]]:
    """Read both; there is no scope where the scene itself is wrong."""
    rungs, wrong = read_rungs(study, trial)
    limits, also_wrong = read_limits(stability, trial, scope)
    return rungs, limits, wrong + also_wrong


def trial_of(table: Table, check: Callable[[Table], object] | None) -> Trial:
    """Make what puts settings on a scene and checks what comes of it, or their paths alone."""

    def under(settings: Table) -> tuple[Table, list[str]]:
        plain = deepcopy({key: value for key, value in table.items() if key not in TABLES})
        mistakes = [m for path, value in settings.items() for m in put(plain, path, value)]
        if check is None or mistakes:
            return plain, mistakes
        try:
            check(plain)
        except SceneError as error:
            # Told beside the rung or the limit, a mistake needs no file name of its own.
            mistakes = [mistake.partition(": ")[2] for mistake in error.mistakes]
        return plain, mistakes

    return under
