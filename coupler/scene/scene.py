"""A checked scene: what is simulated. ``coupler/scene/read.py`` makes it from TOML."""

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, Literal

import pydantic

from quintet.coupler.coupling.exchange import Exchange
from quintet.coupler.coupling.iteration.settings import IterationSettings
from quintet.coupler.coupling.link import Link
from quintet.coupler.coupling.plan import CouplingPlan, Scheme
from quintet.coupler.measures.expectation import Expectation
from quintet.coupler.measures.watched import ErrorBarSettings
from quintet.coupler.scene.begin_table import BeginFrom, Beginning
from quintet.interfaces.component import Field, Fields, Port
from quintet.interfaces.lines.endpoint import Security
from quintet.interfaces.manifest import Manifest, Plan
from quintet.interfaces.params import NotNegative, Number, Positive, Vector, parameters
from quintet.interfaces.serving.port_view import port_fields

NAME = re.compile(r"[A-Za-z0-9_-]+")  # of a component or group: it names files and lines
PLAIN = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]*")  # name of a scene: never a path
Transport = Literal["memory", "zenoh", "mpi"]


@parameters
class ComponentKeys:
    """What components of all kinds have, beside the keys of their own kind.

    Parameters
    ----------
    kind
        An installed kind, or ``module:Class`` of a module beside the scene or in the folder where
        the run is started.
    threads : 1
        That it may use; of each rank, where it has several.
    ranks : 1
        MPI ranks, processes that share its work, if its kind can: over the transports zenoh, as a
        job of their own, and mpi.
    device
        Where it computes: cpu, or opencl:0 and so on, as `quintet devices` lists them; opencl is
        the first. Of several ranks, opencl:0,1 and so on has a number for each; they share the
        device of a single number.
    """

    kind: str
    threads: Annotated[int, pydantic.Field(ge=1, le=1024)] = 1
    ranks: Annotated[int, pydantic.Field(ge=1, le=65536)] = 1
    device: str = "cpu"


@parameters
class GroupSettings:
    """Components with a scheme and windows of their own.

    Parameters
    ----------
    members
        Components, and names of other groups, in the order in which they step.
    scheme
        How the group's windows are stepped.
    window : s
        Between two exchanges of its members, within the window around it; auto follows the state.
    iteration
        How its windows are repeated, under the scheme iterated.
    """

    members: tuple[str, ...]
    scheme: Scheme = "serial"
    window: Positive | Literal["auto"] = "auto"
    iteration: IterationSettings = IterationSettings()


@parameters
class OutputSettings:
    """What a run leaves.

    Parameters
    ----------
    interval : s
        Between two views of the components for ParaView; 0: those of the pictures alone.
    pictures : s
        Times of the pictures.
    colours
        What components are coloured by in pictures: ``"component.field"`` of what they show. Of
        others points take the first field, as speed, and faces none.
    region : m
        Lowest and highest corner of the box that pictures show; particles in front of it, along y,
        are left out, and so are faces that show a field. If not given all is shown.
    displacement_scale : 1
        How many times as large pictures draw displacements, of components that show them.
    totals : s
        Between two rows of the ledger; 0: with the views. Rows of the start and the end always
        stand there.
    snapshots : s
        Between two, to resume from; 0: every ten minutes of the clock, every 5 s where components
        may be started again, and at an interruption.
    states : s
        Times at which the states of all components are kept in a file that stays, for other scenes
        to `begin_from`; windows that follow the state end there, and a time beyond the end is the
        end.
    record
        Whether every exchange is recorded.
    fields
        ``"component.port.field"``: recorded though no link reads them.
    watch
        ``"component.port.field"``: recorded too, and their coupling error is estimated beside that
        of the expectations where `error_bar.on` is set.
    trace
        Whether a table of when each component was ordered to do what, and answered, is written, for
        ``quintet trace``.
    """

    interval: NotNegative = 0.0
    pictures: tuple[NotNegative, ...] = ()
    colours: tuple[str, ...] = ()
    region: tuple[Vector, Vector] | None = None
    displacement_scale: Positive = 1.0
    totals: NotNegative = 0.0
    snapshots: NotNegative = 0.0
    states: tuple[Positive, ...] = ()
    record: bool = True
    fields: tuple[str, ...] = ()
    watch: tuple[str, ...] = ()
    trace: bool = False

    def __post_init__(self) -> None:
        if self.region and not all(low < high for low, high in zip(*self.region, strict=True)):
            raise ValueError(
                f"output.region must be the lowest and the highest corner of a box; found "
                f"{self.region}. Correct it."
            )


@parameters
class SceneFile:
    """The keys of a scene file, but for its components, links and expectations.

    Parameters
    ----------
    name
        Of the scene, and of its folder of runs.
    end : s
        Simulated time at which it ends.
    title
        One line on what it is.
    about
        What it shows, and its source.
    window : s
        Between two exchanges; auto follows the state.
    scheme
        How components step: one after the other, all at once, or repeated until they agree.
    order
        In which components and groups step; as they stand in the file if not given.
    transport
        What carries messages: one process for all, or a process for each component.
    endpoint
        Where the coupler listens, ``tcp/HOST:PORT`` or ``tls/HOST:PORT``; a free port of the
        loopback if not given.
    tls
        Files of authority, certificate and key, for an endpoint off the loopback.
    minutes : min
        Rough run time of the scene as it stands, for ``quintet list``.
    patience : s
        How long a component may keep others waiting beyond three usual windows before it is ended;
        0: as its kind says, 60 s if it does not.
    restarts : 1
        How often each component may be started again when its process dies, over the transport
        zenoh: another process takes over with the same bits. 0: its death ends the run.
    begin_from
        Folder of a run whose state is the start of this one, or a table. Components begin there by
        their names, with positions, velocities and contacts; the time begins at 0.
    iteration
        How windows are repeated, under the scheme iterated.
    output
        What a run leaves.
    error_bar
        Estimate of the error of the coupling.
    """

    name: str
    end: Positive
    title: str = ""
    about: str = ""
    window: Positive | Literal["auto"] = "auto"
    scheme: Scheme = "serial"
    order: tuple[str, ...] = ()
    transport: Transport = "zenoh"
    endpoint: str = ""
    tls: tuple[str, ...] = ()
    minutes: Number = 0.0
    patience: NotNegative = 0.0
    restarts: Annotated[int, pydantic.Field(ge=0, le=1000)] = 0
    begin_from: str | BeginFrom = ""
    iteration: IterationSettings = IterationSettings()
    output: OutputSettings = OutputSettings()
    error_bar: ErrorBarSettings = ErrorBarSettings()


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
    ranks: int = 1
    planned: Plan | None = None  # what running it will need, where its kind can tell
    begun: bool = False  # whether its state at the start is that of another run
    unread: bool = False  # its kind is code that was not imported: keys and ports are unknown
    device: str = "cpu"  # as of `ComponentKeys`

    def initial(self) -> Fields:
        """What is known of it before it is built; see `Manifest`."""
        return self.manifest.initial(self.checked) if self.manifest.initial else {}

    def surroundings(self) -> Fields:
        """What its partners begin in; see `Manifest`."""
        return self.manifest.surroundings(self.checked) if self.manifest.surroundings else {}

    @property
    def shows(self) -> tuple[Field, ...]:
        """Fields of its view, as far as is known without it."""
        return self.manifest.shows or port_fields(self.gives)


@dataclass(slots=True)
class Scene:
    """All that a run needs to know, checked."""

    file: SceneFile
    path: Path
    preset: str
    components: dict[str, ComponentPlan]  # in the order in which they step
    links: list[Link]
    coupling: CouplingPlan
    expect: list[Expectation]
    resolved: dict[str, Any]  # the scene as it runs, for scene.toml
    transport: Transport = "zenoh"
    asked: dict[str, Any] = field(default_factory=dict)  # what `read.load` was given
    beginning: Beginning | None = None  # the state of another run that it begins from
    elsewhere: set[str] = field(default_factory=set)  # components joined by hand
    grace: float = 0.0  # s more for the end of a window and a snapshot, once an end is asked for
    chaos: int | None = None  # seed of the disturbances of the run, if it is to be disturbed

    @property
    def endpoint(self) -> str:
        """Where the coupler listens; "" for a free port of the loopback."""
        return self.file.endpoint

    def first_rank(self, name: str) -> int:
        """Number of a component's first rank in an MPI job of the whole run; 0 is the coupler."""
        before = list(self.components).index(name)
        return 1 + sum(plan.ranks for plan in list(self.components.values())[:before])

    @property
    def tls(self) -> tuple[str, ...]:
        """Authority, certificate and key, or nothing."""
        return self.file.tls

    @property
    def headline(self) -> str:
        """Name, preset and title, above pictures."""
        name, title = self.file.name, self.file.title
        return f"{name}{f' ({self.preset})' if self.preset else ''}{f': {title}' if title else ''}"

    @property
    def security(self) -> Security | None:
        """The same, as the lines take it."""
        return Security(*self.tls) if self.tls else None

    def patience(self, name: str) -> float:
        """How long a component may keep the others waiting beyond three usual windows [s]."""
        return self.file.patience or self.components[name].manifest.patience

    @property
    def folder(self) -> Path:
        """Where the scene and its reference data lie."""
        return self.path.parent

    @property
    def import_folders(self) -> list[str]:
        """See `import_folders`."""
        return import_folders(self.path, self.resolved["components"])

    def exchange(self) -> Exchange:
        """The links of the scene, ready to be joined in a run."""
        return Exchange(
            self.links, {n: (plan.takes, plan.gives) for n, plan in self.components.items()}
        )

    def asked_outputs(self) -> dict[str, set[str]]:
        """Outputs of each component that are wanted although no link reads them."""
        asked: dict[str, set[str]] = {name: set() for name in self.components}
        for expectation in self.expect:
            asked[expectation.component].add(expectation.field)
        for path in (*self.file.output.fields, *self.file.output.watch):
            name, _, key = path.partition(".")
            asked[name].add(key)
        return asked


def import_folders(path: Path, components: Any) -> list[str]:
    """Folders where components named as ``module:Class`` are looked for; none without any."""
    named = ":" in "".join(kinds_of(components))
    return [str(path.parent.resolve()), str(Path.cwd())] if named else []


def kinds_of(components: Any) -> list[str]:
    """Kinds in the tables of the components of a scene, as they stand there."""
    tables = components.values() if isinstance(components, dict) else ()
    return [str(keys.get("kind", "")) for keys in tables if isinstance(keys, dict)]


def wrong_name(name: str) -> list[str]:
    """Check the name of a scene, which is that of a folder as well."""
    if PLAIN.fullmatch(name):
        return []
    return [
        "scene.name must be a plain name of letters, digits, _ . and -, beginning with a letter, a "
        f"digit or _; found {name!r}. Rename it."
    ]
