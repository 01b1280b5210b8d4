"""What every solver must be: it takes fields in, steps, and gives fields out."""

import inspect
from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from quintet.interfaces.errors import PortError, SceneError
from quintet.interfaces.units import check_unit

Array = NDArray[Any]
Fields = Mapping[str, Array]  # "port.field" -> (n, *shape)
Keys = AbstractSet[str]  # of fields: "port.field"
PATIENCE = 60.0  # s, where neither a kind nor a scene says


@dataclass(frozen=True, slots=True)
class Field:
    """One array of a port: ``Field("force", (3,), "N", "impulse")``.

    Parameters
    ----------
    name : str
        Within its port; the key of an array is ``"port.name"``.
    shape : tuple of int
        Of one item; the array is (n, *shape).
    unit : str
        One of `units.UNITS`, or one that was added to them.
    centring : "instant" or "impulse"
        Instants are values at a time. Impulses are rates that act over a step: a component gives
        and takes the rate [N], a link carries its integral over the window [N s], so that
        momentum closes at every subcycling ratio.
    rate : str
        Field of the same port that is this one's time derivative; inputs are then interpolated
        by cubic Hermite polynomials. Of a rotation it is the angular velocity [rad/s].
    kind : "value", "rotation" or "flag"
        A rotation is a unit quaternion w, x, y, z (body to world), interpolated on the sphere. A
        flag is 0 or 1 and never between: what holds at a window's start holds through it.
    works_with : str
        Of a rate that does work: the velocity that it works with, by the name of the field that
        goes the other way over the same link (a force with "velocity").
    labels : bool
        Whole numbers of things that the items of one link belong to; those of the next link are
        counted on from there.

    Raises
    ------
    PortError
        If the unit is not known, or has no integral where one is needed.
    """

    name: str
    shape: tuple[int, ...]
    unit: str
    centring: Literal["instant", "impulse"] = "instant"
    rate: str = ""
    kind: Literal["value", "rotation", "flag"] = "value"
    works_with: str = ""
    labels: bool = False

    def __post_init__(self) -> None:
        check_unit(self.unit, f"field {self.name}", self.centring)
        if self.kind == "rotation" and self.shape != (4,):
            raise PortError(
                f"field {self.name}: a rotation is a quaternion of shape (4,); found "
                f"{self.shape}. Give w, x, y, z."
            )


@dataclass(frozen=True, slots=True)
class Port:
    """A named bundle of fields that all have one row per item.

    ``static`` fields go once, with the port, before the first step (a body's mass);
    ``requests`` go once, against it (the spacing at which the taker wants surfaces sampled); a
    direct link refuses a field ``X`` that exceeds a request ``largest_X`` of one row at the start.
    ``items`` says whose they are: what several links bring to a component's own items is
    added up, what they bring as the partner's items stands in rows one after another. Their
    number never changes: items that may die have a field ``active`` (`ports.ACTIVE`), which is 0
    from then on.
    ``lacks`` has names of fields of this port, and of other ports of the component, that other
    settings would add, each with what to set: a scene that asks for one is told so.
    """

    name: str
    fields: tuple[Field, ...]
    items: Literal["own", "partner"] = "own"
    static: tuple[Field, ...] = ()
    requests: tuple[Field, ...] = ()
    lacks: tuple[tuple[str, str], ...] = ()


def lacked(ports: Iterable[Port], path: str) -> str:
    """What to set for ports to have a field, ``"port.field"``; "" where nothing would help."""
    remedies = {f"{port.name}.{name}": remedy for port in ports for name, remedy in port.lacks}
    return remedies.get(path, "")


@dataclass(slots=True)
class Totals:
    """What a component holds, for the ledger; SI, world frame, moments about the origin."""

    mass: float = 0.0  # kg
    momentum: Array = field(default_factory=lambda: np.zeros(3))  # (3,) kg m/s
    angular_momentum: Array = field(default_factory=lambda: np.zeros(3))  # (3,) kg m2/s
    kinetic: float = 0.0  # J
    potential: float = 0.0  # J, gravity
    internal: float = 0.0  # J, elastic and thermal
    work: float = 0.0  # J, done on it so far by what no link brings: loads of the scene, walls
    # J that friction, viscosity or damping took so far and `internal` and `work` do not hold; 0
    # where they hold all of it; None: not known.
    dissipated: float | None = None
    # kg by reason: what it began with, what came since, and, negative, what left. They add up to
    # `mass`. Empty: not known.
    mass_balance: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Resources:
    """What a component may use of the machine.

    Parameters
    ----------
    threads : int
        Threads that it may keep busy at a time.
    folder : Path
        The scene's folder; data files are looked for here, nowhere else.
    communicator : mpi4py communicator or None
        Of a component that owns several MPI ranks: all methods are called on all of them, and what
        rank 0 returns counts.
    device : str
        Where it computes: "cpu", or "opencl:0" and so on, where its manifest names a component for
        devices. Of several ranks it may have a number for each: "opencl:0,1".
    """

    threads: int = 1
    folder: Path = field(default_factory=Path)
    communicator: Any = None
    device: str = "cpu"


ONE_THREAD = Resources()


class Component(ABC):
    """A solver that the coupler can drive; it knows nothing of the others.

    It is made as ``Component(params)`` or, if it needs them, ``Component(params, resources)``.
    Keys of all fields are ``"port.field"``. Arrays that come in are read-only and are not
    kept; arrays that go out are copies.
    """

    takes: tuple[Port, ...] = ()
    gives: tuple[Port, ...] = ()
    compiles: bool = False  # whether to try a step, which is undone, before the run's clock starts
    shows: tuple[Field, ...] = ()  # fields of its view; the first is drawn if a scene names none
    gives_integrals: bool = False  # whether `give` returns integrals over the last step, not rates
    items_vary: bool = False  # whether it may come to have more items than it began with
    walls_move: bool = False  # whether parts of `walls` move: then each view has them again
    ranks: bool = False  # whether it can own several MPI ranks
    patience: float = PATIENCE  # s, how long it may keep others waiting beyond three usual windows
    Params: Any = None  # its parameter class, where no manifest names one
    manifest: ClassVar[Any] = None  # of a kind that publishes one; classes derived from it have it

    @classmethod
    def ports_of(cls, params: Any) -> tuple[tuple[Port, ...], tuple[Port, ...]]:
        """Ports that it takes and gives with these parameters, known before it is made."""
        if cls.manifest is None:
            return cls.takes, cls.gives
        takes, gives = cls.manifest.ports(params)
        return takes, gives

    @classmethod
    def plan_of(cls, params: Any) -> Any:
        """What a run will need with these parameters: a `manifest.Plan`; None: not known."""
        return cls.manifest.plan(params) if cls.manifest and cls.manifest.plan else None

    @classmethod
    def initial_of(cls, params: Any) -> Fields:
        """What it will describe and give at the start, as far as the parameters tell it."""
        return cls.manifest.initial(params) if cls.manifest and cls.manifest.initial else {}

    @classmethod
    def complete_of(cls, keys: dict[str, Any], partners: Fields) -> dict[str, Any]:
        """Return its table of a scene, completed by what its partners state at the start."""
        completes = cls.manifest.complete if cls.manifest else None
        return completes(keys, partners) if completes else keys

    @staticmethod
    def conform_cases() -> tuple[Any, ...]:
        """`manifest.ConformCase`s, on which ``quintet conform`` tries the laws of the contract."""
        return ()

    def describe(self) -> Fields:
        """Static fields of the ports it gives, and its requests at those it takes."""
        return {}

    def sample(self, request: Fields) -> Fields:
        """Answer how its surface is sampled, in its own frame; after `describe`, before `bind`.

        Parameters
        ----------
        request : mapping of arrays
            Of one of its ports. Of ``motion`` and ``faces`` one row each of ``spacing``, ``depth``
            (below the outermost samples) and ``inset`` (of these below the surface), all in m, of
            ``mirror`` (1 if the image of each sample in the surface is asked for) and
            ``dimensions`` (2 or 3). Of other meshes ``points`` (n, 3) m that hang on it. Of
            ``contact_surface`` a row ``inner``, where the component takes contact_surface_load.

        Returns
        -------
        mapping of arrays
            Of the same port, a row for each sample. Of rigid bodies ``arm`` m, outward ``normal``,
            ``volume`` m3, number of the ``body``, ``image`` m if asked for. Of faces ``node``
            (n, 4) and, of these nodes, ``weight``, ``along`` and ``across`` (n, 4), shape
            functions and their derivatives, ``depth`` m, ``side`` m, ``normal``, ``volume`` m3.
            Of points ``node``, ``weight``, ``face``, and in m ``gap``, ``size`` and ``beyond``. Of
            inner faces the static fields of the port again, with the nodes and faces that were
            described first.
            `components.shared.geometry` computes all of these from dimensions or a mesh.
        """
        raise PortError(
            f"{type(self).__name__} cannot be sampled, for it has no method sample; a partner asks "
            f"for {', '.join(request)}. Give it one, or leave it out of the link."
        )

    def bind(self, static: Fields, joined: AbstractSet[str]) -> None:  # noqa: B027  (most need none)
        """Join its ports; once, before the first take.

        Parameters
        ----------
        static : mapping of arrays
            Static fields of the ports it takes that are joined.
        joined : set of str
            Names of its ports that have a partner.
        """

    def rank_rows(self, port: str) -> Array | None:
        """Rows (k,) of a port that this rank of several works on; None: all, or unknown.

        Of a port it takes: those that it needs from now on, asked once, after `bind`. In fields
        that come later the others mean nothing; rank 0 has all. Of a port it gives: those that it
        computes now; a number that is not finite is reported with its rank.
        """
        return None

    def prime(self, fields: Fields) -> None:  # noqa: B027  (most need none)
        """Learn what the inputs that are instants are as the run begins; once, after `bind`."""

    @abstractmethod
    def stable_dt(self) -> float:
        """Largest step that the present state allows [s]: told after every window."""

    @abstractmethod
    def take(self, fields: Fields) -> None:
        """Set the inputs; they hold until the next take. Rates, not integrals."""

    @abstractmethod
    def step(self, dt: float) -> None:
        """Advance by exactly dt [s]."""

    @abstractmethod
    def give(self, wanted: Keys) -> Fields:
        """Copy out the outputs: instants at the present time, means over the last step.

        Parameters
        ----------
        wanted : set of str
            Keys that somebody reads; just these are given. Asked for impulses after every
            step, for instants at the window's end.
        """

    @abstractmethod
    def save(self) -> Fields:
        """Copy out all state."""

    @abstractmethod
    def load(self, state: Fields) -> None:
        """Come back to a saved state, bit for bit."""

    def begin_from(self, state: Fields) -> None:
        """Begin from a state that a component of this kind saved in another run.

        Called after `bind`, instead of the start that the parameters describe. The clock begins at
        0, and the parameters may be others than those of that run, where the kind allows it; if
        nothing has changed, it must go on with the same bits. By default the state is loaded.

        Raises
        ------
        SceneError
            Where the state does not suit the parameters.
        """
        count = self.items()
        self.load(state)
        if self.items() > count and not self.items_vary:  # fewer: some have left
            raise SceneError(
                f"the state that it begins from must be of its {count} items; found "
                f"{self.items()}. Make both scenes alike, or leave it out of begin_from.components."
            )

    def totals(self) -> Totals:
        """Mass, momentum and energies of what it holds."""
        return Totals()

    def view(self) -> Fields:
        """What pictures and ParaView show of its present state.

        ``points`` (n, 3) m; optional ``cells`` (m, 3 or more): polygons, by the numbers of their
        corners, -1 after the last corner of those with fewer. All other fields have a row for each
        point or for each cell, and stand with their units in `shows`; ``radius`` [m] tells
        that points are spheres. By default nothing: then the bodies, meshes or points are shown
        whose positions it gives.
        """
        return {}

    def walls(self) -> Fields:
        """What stands still around it, for pictures: ``points`` and ``cells`` as in a view.

        With `walls_move` some of it may move; points and cells keep their order and number.

        Optional ``support`` (cells,) tells which are walls, clamped faces of bodies and planes of
        symmetry, by the numbers of `interfaces.faces`; without it all are walls.
        """
        return {}

    def notes(self) -> tuple[str, ...]:
        """Sentences that the user should read: all so far, in the order in which they came up."""
        return ()

    def check(self) -> None:
        """Raise `StepError`, with the place, where an item's state is not valid.

        Called at the end of every window, for numbers that the steps do not check: a number that
        is not finite must be found in the window in which it arises. It costs at most 1 % of it.
        """
        return

    def warnings(self) -> Mapping[str, str]:
        """Reasons why the results may be wrong, by subject: ``{"energy": "the energy rose ..."}``.

        Judged from the present state alone: after `load` it is that of the loaded state. Asked at
        the end of every window. The run goes on, and ends with status 1. Each text says what is
        wrong, the value found and what to do. `notes` are for what the component corrected.
        """
        return {}

    def final_warnings(self) -> Mapping[str, str]:
        """Warnings that only the whole run can justify, by subject; called once, at its end.

        Not called where a run is interrupted or fails. Printed and reported as `warnings` are.
        """
        return {}

    def items(self) -> int:
        """How many particles, bodies or elements it advances per step."""
        return 1


def make(cls: type[Component], params: Any, resources: Resources) -> Component:
    """Make a component, with its resources if its constructor takes them."""
    makes: Any = cls
    takes = inspect.signature(cls).parameters
    component: Component = makes(params, resources) if len(takes) > 1 else makes(params)
    return component


def outputs_of(component: Component) -> Fields:
    """All outputs of a component as they are now."""
    return component.give(frozenset(fields_of(component.gives)))


def fields_of(ports: tuple[Port, ...]) -> dict[str, Field]:
    """All fields of some ports, by their keys ``"port.field"``."""
    return {f"{port.name}.{field.name}": field for port in ports for field in port.fields}


def port_text(port: Port) -> str:
    """A port and its fields with their units, in words."""
    fields = [
        f"{field.name} [{field.unit}{', impulse' * (field.centring == 'impulse')}]"
        for field in port.fields
    ]
    return f"{port.name} ({', '.join(fields)})"
