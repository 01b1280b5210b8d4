"""Variants of a scene: its refinements, limits, scans, controls and ensemble, checked with it."""

from collections.abc import Callable
from copy import deepcopy
from dataclasses import dataclass, field

from quintet.coupler.scene.control_table import Control, MakeControl, read_controls
from quintet.coupler.scene.ensemble_table import Perturbation, read_perturbations
from quintet.coupler.scene.overrides import put, put_preset
from quintet.coupler.scene.scan_table import Scan, read_scans
from quintet.coupler.scene.stability_checks import Scope, read_limits
from quintet.coupler.scene.stability_table import Limit
from quintet.coupler.scene.study_table import InSi, Refinement, read_refinements
from quintet.coupler.scene.varied_tables import MakeVariant, Table
from quintet.interfaces.errors import SceneError

LISTS = ("study", "stability", "scan", "control")  # tables in lists
ENSEMBLE = "ensemble"  # tables by name
VARIED = (*LISTS, ENSEMBLE)


@dataclass(frozen=True, slots=True)
class Variants:
    """Refinements, stability limits, scans, controls and ensemble of a scene."""

    study: list[Refinement] = field(default_factory=list)
    stability: list[Limit] = field(default_factory=list)
    scan: list[Scan] = field(default_factory=list)
    control: list[Control] = field(default_factory=list)
    ensemble: list[Perturbation] = field(default_factory=list)


def read_variants(
    tables: dict[str, list[Table]],
    scene: Table,
    check: Callable[[Table], object] | None,
    scope: Scope | None,
    preset: str = "",
    with_ensemble: bool = True,
    si: InSi = lambda _, value: value,
) -> tuple[Variants, list[str]]:
    """Check refinements, limits, scans, controls and ensemble; with mistakes there is no scope.

    Controls are those of the scene without a preset. `si` is that of `read_refinements`.
    """
    make_variant = variant_maker(scene, check)
    inherits = bool(preset) and "scan" not in scene["presets"][preset]
    refinements, wrong = read_refinements(tables["study"], make_variant, si)
    limits, wrong_limits = read_limits(tables["stability"], make_variant, scope)
    expected = scope.expected if scope else None
    scans, wrong_scans = read_scans(tables["scan"], make_variant, expected, inherits)
    control_tables = [] if preset else tables["control"]
    make_control = control_maker(scene, check)
    controls, wrong_controls = read_controls(control_tables, make_control, scene, expected)
    perturbations = scene.get(ENSEMBLE, {}) if with_ensemble else {}
    drawn, wrong_draws = read_perturbations(perturbations, scene, make_variant)
    mistakes = wrong + wrong_limits + wrong_scans + wrong_controls + wrong_draws
    return Variants(refinements, limits, scans, controls, drawn), mistakes


def variant_maker(table: Table, check: Callable[[Table], object] | None) -> MakeVariant:
    """Return a function that applies settings to a scene and checks it, or their paths alone."""
    make_control = control_maker(table, check)
    return lambda settings: make_control("", settings)


def control_maker(table: Table, check: Callable[[Table], object] | None) -> MakeControl:
    """Return a function that applies a preset and settings to a scene, and checks it."""

    def make_control(preset: str, settings: Table) -> tuple[Table, list[str]]:
        plain = deepcopy({key: value for key, value in table.items() if key not in VARIED})
        mistakes = put_preset(plain, preset) if preset else []
        mistakes += [m for path, value in settings.items() for m in put(plain, path, value)]
        for key in VARIED:  # of the preset
            plain.pop(key, None)
        if check is None or mistakes:
            return plain, mistakes
        try:
            check(plain)
        except SceneError as error:
            # The refinement or limit is named before the mistake: no file name is needed.
            mistakes = [mistake.partition(": ")[2] for mistake in error.mistakes]
        return plain, mistakes

    return make_control
