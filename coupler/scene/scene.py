"""What is simulated: a checked scene. ``coupler/read.py`` makes it from TOML."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from quintet.coupler.coupling.exchange import Link
from quintet.coupler.coupling.schedule import Iteration
from quintet.coupler.measures.expectation import Expectation
from quintet.coupler.scene.stability_table import Limit
from quintet.coupler.scene.study_table import Refinement
from quintet.interfaces.component import Port
from quintet.interfaces.lines.endpoint import Security
from quintet.interfaces.manifest import Manifest, Plan
from quintet.interfaces.params import Count, NotNegative, Number, Positive, parameters

Transport = Literal["memory", "zenoh", "mpi"]


@parameters
class IterationSettings:
    """``[iteration]``: how windows are repeated."""

    tolerance: Positive = 1e-6
    limit: Count = 50
    relaxation: Positive = 0.5
    aitken: bool = True


@parameters
class OutputSettings:
    """``[output]``: what a run leaves."""

    interval: NotNegative = 0.0  # s between two pictures' worth of particles; 0: none
    pictures: tuple[NotNegative, ...] = ()  # s, times of the pictures
    totals: NotNegative = 0.0  # s between two rows of the ledger; 0: with the particles
    snapshots: NotNegative = 0.0  # s between two, to resume from; 0: now and then, and at an end
    record: bool = True  # every exchange


@parameters
class SceneFile:
    """The keys of a scene file, but for its components, links and expectations."""

    name: str
    end: Positive  # s
    title: str = ""
    about: str = ""  # what it shows, and its source
    window: Positive | Literal["auto"] = "auto"  # s between two exchanges
    scheme: Literal["serial", "parallel", "iterated"] = "serial"
    order: tuple[str, ...] = ()  # in which components step; as they stand in the file
    transport: Transport = "zenoh"
    endpoint: str = ""  # where the coupler listens; a free port of the loopback
    tls: tuple[str, ...] = ()  # authority, certificate, key
    minutes: Number = 0.0  # rough run time of the scene as it stands
    iteration: IterationSettings = IterationSettings()
    output: OutputSettings = OutputSettings()


@dataclass(slots=True)
class ComponentPlan:
    """One component of a scene."""

    name: str
    kind: str
    manifest: Manifest
    params: dict[str, Any]  # as they go to the component
    checked: Any  # the same as a parameter object
    takes: tuple[Port, ...]
    gives: tuple[Port, ...]
    threads: int = 1

    def plan(self) -> Plan | None:
        """What running it will need, where its kind can tell."""
        return self.manifest.plan(self.checked) if self.manifest.plan else None


@dataclass(slots=True)
class Scene:
    """All that a run needs to know, checked."""

    file: SceneFile
    path: Path
    preset: str
    components: dict[str, ComponentPlan]  # in the order in which they step
    links: list[Link]
    expect: list[Expectation]
    resolved: dict[str, Any]  # the scene as it runs, for scene.toml
    transport: Transport = "zenoh"
    asked: dict[str, Any] = field(default_factory=dict)  # what `read.load` was given
    study: list[Refinement] = field(default_factory=list)
    stability: list[Limit] = field(default_factory=list)
    elsewhere: set[str] = field(default_factory=set)  # components joined by hand

    @property
    def endpoint(self) -> str:
        """Where the coupler listens; "" for a free port of the loopback."""
        return self.file.endpoint

    @property
    def tls(self) -> tuple[str, ...]:
        """Authority, certificate and key, or nothing."""
        return self.file.tls

    @property
    def security(self) -> Security | None:
        """The same, as the lines take it."""
        return Security(*self.tls) if self.tls else None

    @property
    def folder(self) -> Path:
        """Where the scene and its reference data lie."""
        return self.path.parent

    @property
    def import_folders(self) -> list[str]:
        """Where components named as ``module:Class`` are looked for."""
        return [str(self.folder.resolve()), str(Path.cwd())]

    def iteration(self) -> Iteration:
        """Settings of the iterated scheme."""
        one = self.file.iteration
        return Iteration(one.tolerance, one.limit, one.relaxation, one.aitken)
