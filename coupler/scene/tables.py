"""The tables of a scene file beside its own keys, all of them."""

from dataclasses import field
from typing import Any

from quintet.coupler.coupling.links.keys import LinkKeys
from quintet.coupler.measures.expectation import Expectation
from quintet.coupler.scene.control_table import ControlTable
from quintet.coupler.scene.ensemble_table import PerturbationTable
from quintet.coupler.scene.scan_table import ScanTable
from quintet.coupler.scene.scene import ComponentKeys, GroupSettings
from quintet.coupler.scene.stability_table import LimitTable
from quintet.coupler.scene.study_table import RefinementTable
from quintet.interfaces.params import parameters


@parameters
class SceneTables:
    """Tables of a scene.

    Parameters
    ----------
    components
        At least one; with them stand the keys of their kinds.
    links
        What joins their ports; with them stand the keys of their kinds.
    materials
        Constants by the names of materials, or a file beside the scene that has them; components
        name them like those of the library.
    groups
        Components with a scheme and windows of their own.
    expect
        Numbers that the run must reproduce.
    presets
        Settings by dotted path, for ``--preset NAME``.
    stand_ins
        By component and kind: the keys of a kind that ``--swap`` puts in its place.
    study
        Refinements of a convergence study, from coarse to fine.
    stability
        Limits of stability.
    scan
        Settings varied from safe to absurd, to see whether wrong results are reported.
    control
        Wrong settings that the tolerances of expectations must reject.
    ensemble
        By name: what is uncertain, and how it is distributed.
    """

    components: dict[str, ComponentKeys]
    links: tuple[LinkKeys, ...] = ()
    materials: str | dict[str, dict[str, Any]] = field(default_factory=dict)
    groups: dict[str, GroupSettings] = field(default_factory=dict)
    expect: tuple[Expectation, ...] = ()
    presets: dict[str, dict[str, Any]] = field(default_factory=dict)
    stand_ins: dict[str, dict[str, dict[str, Any]]] = field(default_factory=dict)
    study: tuple[RefinementTable, ...] = ()
    stability: tuple[LimitTable, ...] = ()
    scan: tuple[ScanTable, ...] = ()
    control: tuple[ControlTable, ...] = ()
    ensemble: dict[str, PerturbationTable] = field(default_factory=dict)
