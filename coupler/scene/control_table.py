"""``[[control]]``: a wrong setting that the tolerances of expectations must reject.

    [[control]]
    name = "no friction"
    settings = { "components.cube.friction" = 0.0 }
    rejects = ["slope.creep"]
    reason = "without friction the block slides"

With a `preset` the same expectations must hold in that preset, and be met by it without the
settings: the settings alone are then what is rejected.
"""

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import pydantic

from quintet.coupler.measures.expectation import Expectation
from quintet.coupler.scene.varied_tables import REDUCED, Table, read_tables
from quintet.interfaces.params import parameters, shown, unknown

# preset, settings -> scene with them, mistakes
MakeControl = Callable[[str, Table], tuple[Table, list[str]]]


@parameters
class ControlTable:
    """A negative control: a wrong setting that the tolerances of expectations must reject.

    Parameters
    ----------
    name
        Of the control.
    preset
        A preset of the scene on which it is based, as a cheaper one. With settings the preset alone
        must meet the expectations; without them the preset is what is wrong.
    settings
        What is wrong, by dotted path, on top of the scene and the preset.
    rejects
        Names of the expectations that must not be met.
    reason
        What is wrong, and why the result must be.
    """

    name: str
    preset: str = ""
    settings: dict[str, Any] = pydantic.Field(default_factory=dict)
    rejects: tuple[str, ...]
    reason: str

    def __post_init__(self) -> None:
        rules = [
            (not self.name, "name must not be empty. Name what is wrong."),
            (not self.rejects, "rejects must name an expectation; found none. Name one."),
            (not self.reason, "reason must not be empty. Say why the result must be wrong."),
            (
                not (self.settings or self.preset),
                "settings must change the scene; found none. Set what is wrong.",
            ),
        ]
        wrong = [sentence for is_wrong, sentence in rules if is_wrong]
        if wrong:
            raise ValueError(" ".join(wrong))


@dataclass(frozen=True, slots=True)
class Control:
    """One control, checked."""

    table: ControlTable

    @property
    def settings(self) -> Table:
        """Settings of its run."""
        return {**REDUCED, "output.record": True, **self.table.settings}

    @property
    def has_base(self) -> bool:
        """Whether its preset alone is run too, which must meet the expectations."""
        return bool(self.table.preset and self.table.settings)

    @property
    def base_settings(self) -> Table:
        """Settings of the run of its preset alone."""
        return {**REDUCED, "output.record": True}


def read_controls(
    tables: list[Table],
    make_control: MakeControl,
    scene: Table,
    expected: Mapping[str, Expectation] | None,
) -> tuple[list[Control], list[str]]:
    """Check the controls of a scene; without its expectations only their form.

    Parameters
    ----------
    tables : list of dict
        The controls as they stand in the scene file.
    make_control : callable
        Applies a preset and settings to the scene and checks it.
    scene : dict
        The scene as it stands in the file.
    expected : mapping or None
        Expectations of the scene, by name.
    """
    controls: list[Control] = []
    mistakes: list[str] = []
    for place, table in read_tables(ControlTable, "control", "name", tables, mistakes):
        controls.append(Control(table))
        if expected is None:
            continue
        wrong = [
            unknown(f"rejects {name}", name, expected)
            for name in table.rejects
            if name not in expected
        ]
        varied, wrong_settings = make_control(table.preset, table.settings)
        wrong += wrong_settings
        if not wrong:
            wrong = _changed(table, _expectations(scene), _expectations(varied))
        mistakes += [f"{place}: {mistake}" for mistake in wrong]
    counts = Counter(control.table.name for control in controls)
    mistakes += [
        f"control: {count} have the name {shown(name)}. Give each its own."
        for name, count in counts.items()
        if count > 1
    ]
    return controls, mistakes


def _expectations(scene: Table) -> dict[str, Table]:
    return {str(table.get("name")): table for table in scene.get("expect", [])}


def _changed(
    table: ControlTable, original: Mapping[str, Table], varied: Mapping[str, Table]
) -> list[str]:
    """Refuse expectations that the control itself changes, or that its preset lacks."""
    sentences = []
    for name in table.rejects:
        if name not in varied:
            sentences.append(
                f"rejects {name}: preset {table.preset} must have this expectation; it has not. "
                "Choose another preset."
            )
            continue
        keys = sorted(original[name].keys() | varied[name].keys())
        changed = [key for key in keys if original[name].get(key) != varied[name].get(key)]
        if changed:
            sentences.append(
                f"rejects {name}: a control must be judged by the expectation of the scene; found "
                f"another {', '.join(changed)}. Leave it as it is, or choose another preset."
            )
    return sentences
