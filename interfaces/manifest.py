"""What a kind of component publishes about itself, so that a scene is checked without it.

A manifest is light: importing it imports no solver. Kinds are found by name under the
entry-point group ``quintet.components``, or as ``module:Class``.
"""

import sys
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from typing import Any

from quintet.interfaces.component import PATIENCE, Array, Component, Field, Fields, Keys, Port
from quintet.interfaces.errors import SceneError
from quintet.interfaces.installed import installed
from quintet.interfaces.params import unknown

Ports = tuple[tuple[Port, ...], tuple[Port, ...]]  # takes, gives


@dataclass(frozen=True, slots=True)
class Plan:
    """What a run of a component will need, guessed from its parameters alone.

    It is asked for before anything is allocated, so it makes no particles: it counts them.
    """

    items: int  # particles, bodies, elements
    dt: float  # s, a typical step; inf: any
    rate: float = 1e6  # items stepped per second and thread
    bytes_per_item: float = 0.0
    times: Array | None = None  # (n,) s, the only ones at which it can give; None: at any
    notes: tuple[str, ...] = ()  # sentences that `check` prints
    serial: float = 1.0  # share of a step's time on one thread that more threads do not shorten


@dataclass(frozen=True, slots=True)
class BenchCase:
    """A component whose throughput is measured, as a scene would make it."""

    name: str
    params: dict[str, Any]  # a scene's table for this kind
    warm: int  # steps before the clock starts: kernels are compiled, lists are made
    steps: int  # measured, each of stable_dt
    unit: str  # of the rate: "particle-steps/s"
    static: Fields = field(default_factory=dict)  # what its partners tell it once
    fields: Fields = field(default_factory=dict)  # what it takes before each step
    series: str = ""  # that of cases that differ in their number of items alone
    device: str = "cpu"  # on which it computes


@dataclass(frozen=True, slots=True)
class ConformCase:
    """A component on which ``quintet conform`` tries the laws of the contract.

    Parameters
    ----------
    name : str
    params : dict, or function of a folder
        A scene's table for this kind; or what makes it, and the data files that it names, in an
        empty folder.
    static : mapping of arrays
        Static fields of partners, as `Component.bind` gets them.
    rest : mapping of arrays
        Inputs under which nothing happens. Ports that it takes are joined if their fields stand
        here or in `static`.
    scale : mapping of float, or of one for each component
        How far each of these fields is moved from rest, at random, in its unit; of a rotation in
        rad.
    dt : float, s
        Step that is tried, and halved.
    still : bool
        Whether it stays as it is at rest.
    smooth : bool
        Whether its answer to constant inputs is smooth in time, so that two half steps come ever
        nearer to one.
    any_time : bool
        Whether it can give after a step of any size.
    forces : tuple of str
        Forces that it takes, and those that it gives to its partners, if nothing else changes its
        momentum; else empty.
    activity : mapping of tuples of str
        Of a field ``active``: ports whose items it is about, beside its own.
    device : str
        On which it computes.
    """

    name: str
    params: dict[str, Any] | Callable[[Path], dict[str, Any]]
    static: Fields = field(default_factory=dict)
    rest: Fields = field(default_factory=dict)
    scale: Mapping[str, float | tuple[float, ...]] = field(default_factory=dict)
    dt: float = 1e-3
    still: bool = True
    smooth: bool = True
    any_time: bool = True
    forces: tuple[str, ...] = ()
    activity: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    device: str = "cpu"


@dataclass(frozen=True, slots=True)
class Manifest:
    """A kind: its parameters, its ports, and where its class is.

    ``ports``, ``plan`` and ``initial`` are functions of the checked parameters; ``bench`` and
    ``conform`` name functions that return tuples of `BenchCase` and `ConformCase`. ``initial``
    tells, as far as that is known without the solver, what the component will describe and the
    instants that it gives at the start: by these a link is checked before anything runs.
    ``complete`` returns its table of a scene with what its partners know already: it gets the
    table, unchecked, and what they state in ``initial``, by the names of the ports that take it.
    ``joins`` refuses, with a `SceneError`, what its component's `bind` would refuse: it gets the
    parameters, the static fields of partners as far as their ``initial`` has them, and the names of
    the ports that are joined.
    ``surroundings`` tells what partners begin in, as still water, for the next two alone. These
    get the parameters and the ``surroundings`` of one partner. ``meets`` refuses, with a
    `SceneError`, what does not fit into them; as it is called whenever a scene is read, it must be
    cheap. ``meeting_notes`` returns sentences that `check` prints.
    """

    kind: str
    title: str
    params: type
    component: str  # "module:Class"
    ports: Callable[[Any], Ports]
    plan: Callable[[Any], Plan | None] | None = None
    initial: Callable[[Any], Fields] | None = None
    complete: Callable[[dict[str, Any], Fields], dict[str, Any]] | None = None
    joins: Callable[[Any, Fields, Keys], None] | None = None
    surroundings: Callable[[Any], Fields] | None = None
    meets: Callable[[Any, Fields], None] | None = None
    meeting_notes: Callable[[Any, Fields], tuple[str, ...]] | None = None
    bench: str = ""  # "module:function"
    conform: str = ""  # "module:function"
    patience: float = PATIENCE  # s, how long it may keep others waiting beyond three usual windows
    shows: tuple[Field, ...] = ()  # as of the component
    ranks: bool = False  # whether a component may own several MPI ranks
    ranks_limits: str = ""  # "module:function" of parameters and ranks: refuses with SceneError
    opencl: str = ""  # "module:Class" of a component that computes on OpenCL devices
    opencl_limits: str = ""  # "module:function" of parameters and device: refuses with SceneError
    opencl_ranks: str = ""  # the same of parameters and ranks, if it can own several on devices

    def load(self, device: str = "cpu") -> type[Any]:
        """Import the solver itself, for a device; only the process that runs it does so."""
        path = self.component if device == "cpu" else self.opencl
        if not path:
            raise SceneError(
                f"kind {self.kind} must compute on the processor; found the device {device}. "
                'Set device = "cpu".'
            )
        cls = resolve(path)
        if not (isinstance(cls, type) and issubclass(cls, Component)):
            raise SceneError(f"kind {self.kind}: {path} is not a Component.")
        return cls

    def check_ranks(self, params: Any, ranks: int) -> None:
        """Refuse checked parameters that the component cannot share out among its ranks."""
        if ranks > 1 and self.ranks_limits:
            resolve(self.ranks_limits)(params, ranks)

    def check_device(self, params: Any, device: str, ranks: int = 1) -> None:
        """Refuse checked parameters that the component for a device cannot compute on its ranks."""
        if device != "cpu" and self.opencl_limits:
            resolve(self.opencl_limits)(params, device)
        if device != "cpu" and ranks > 1 and self.opencl_ranks:
            resolve(self.opencl_ranks)(params, ranks)

    def cases(self) -> tuple[BenchCase, ...]:
        """Benchmarks of this kind, none if it declares none."""
        return tuple(resolve(self.bench)()) if self.bench else ()

    def conform_cases(self) -> tuple[ConformCase, ...]:
        """What the laws of the contract are tried on: none if neither it nor its class says."""
        if self.conform:
            return tuple(resolve(self.conform)())
        return tuple(self.load().conform_cases())


_looked_in: list[str] = []  # folders that `look_in` has put on the import path


def look_in(folders: Iterable[str]) -> None:
    """Look for modules of components in these folders too, after all that is installed.

    A file there must never stand for a module of Python or of a package that has its name.
    """
    path_before = [path for path in sys.path if path not in _looked_in]
    new = [folder for folder in dict.fromkeys(folders) if folder not in path_before]
    _looked_in[:] = [*new, *(folder for folder in _looked_in if folder not in new)]
    sys.path[:] = [*path_before, *_looked_in]


def resolve(path: str) -> Any:
    """Import ``module:name``."""
    module, _, name = path.partition(":")
    return getattr(import_module(module), name)


def manifest_of(cls: type[Component], path: str, kind: str = "") -> Manifest:
    """Manifest of a class that publishes none: its ``Params`` and its ports.

    `path` is its ``module:Class``, by which it is also named if it has no name as a `kind`.
    """
    kind = kind or path
    if not (isinstance(cls, type) and issubclass(cls, Component)):
        raise SceneError(f"kind {kind}: {cls!r} is not a Component. Derive it from Component.")
    if cls.Params is None:
        raise SceneError(
            f"kind {kind}: a component class must have a Params dataclass; {cls.__name__} has "
            "none. Write `@parameters class Params` inside it."
        )
    title = (cls.__doc__ or kind).strip().splitlines()[0].removesuffix(".")
    functions = (cls.ports_of, cls.plan_of, cls.initial_of, cls.complete_of)
    return Manifest(
        kind, title, cls.Params, path, *functions, patience=cls.patience, shows=cls.shows,
        ranks=cls.ranks,
    )  # fmt: skip


def known_kinds() -> dict[str, str]:
    """Names under which components are installed, with the paths that they stand for."""
    return {entry.name: entry.value for entry in installed("quintet.components")}


def unknown_kind(where: str, kind: str, more: Iterable[str] = ()) -> str:
    """Sentence about a kind that is not installed; a renamed one is answered with its new names.

    New names stand in a tuple, named by an entry point of the group
    ``quintet.renamed_components``.
    """
    for entry in installed("quintet.renamed_components"):
        if entry.name == kind:
            return f"{where} is now {' or '.join(entry.load())}. Rename it."
    return unknown(where, kind, [*more, *known_kinds()])


def find(kind: str) -> Manifest:
    """Manifest of a kind, given by its installed name or as ``module:Class``."""
    path = kind if ":" in kind else known_kinds().get(kind, "")
    if not path:
        raise KeyError(kind)
    target = resolve(path)
    return target if isinstance(target, Manifest) else manifest_of(target, path, kind)
