"""A link: what it carries between two components, what it needs of time, the maps that it makes.

Links are data of a scene and remember nothing.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from quintet.interfaces.component import Array, Fields, Port

Ports = tuple[tuple[Port, ...], tuple[Port, ...]]  # takes, gives
Ends = Mapping[str, Fields]  # outputs of both components of a transfer at one end of a window
Mapped = dict[str, Array]


@dataclass(frozen=True, slots=True)
class Transfer:
    """One direction of a link: from the giver's outputs to the taker's inputs.

    Parameters
    ----------
    giver, taker : str
        Names of components.
    reads : tuple of str
        Outputs of the giver that are mapped.
    needs : tuple of str
        Outputs of the taker that the mapping looks at too (the pose of a loaded body).
    fills : tuple of str
        Inputs of the taker that it makes.
    conservative : bool
        Whether mapping keeps the sums of impulses; of displacements it keeps the values instead.
    """

    giver: str
    taker: str
    reads: tuple[str, ...]
    fills: tuple[str, ...]
    needs: tuple[str, ...] = ()
    conservative: bool = True

    @property
    def ends(self) -> tuple[str, str]:
        """Both components."""
        return self.giver, self.taker


@dataclass(frozen=True, slots=True)
class Demands:
    """What a link needs of time.

    Parameters
    ----------
    equal_steps : bool
        Whether both sides must step once in every window.
    schemes : tuple of str
        Schemes under which it is stable.
    relaxation : tuple of float
        Share of the change of its instants that is handed on, in the first windows; the last
        one holds for all the others. Empty: all of it.
    settles : bool
        Whether what it hands on must come to rest from window to window, as the temperature
        between two bars; it is then watched for swings instead of being stepped twice.
    reason : str
        Why, for whoever asks for something else.
    judged : bool
        Whether windows are judged by the error in time of what it carries; not where they are the
        steps of both sides, which resolve no vibration of the highest frequency.
    by_sound : bool
        Whether the force that it carries answers a change of velocity by sound, with the less
        momentum the shorter the window; the advice against an unstable coupling then begins with a
        shorter window.
    first : tuple of str
        Two components, of which the first must step before the other under the scheme serial;
        empty: any order.
    """

    equal_steps: bool = False
    schemes: tuple[str, ...] = ("serial", "parallel", "iterated")
    relaxation: tuple[float, ...] = ()
    settles: bool = False
    reason: str = ""
    judged: bool = True
    by_sound: bool = False
    first: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Binding:
    """What a link made of two components' static fields: the maps between their items.

    Parameters
    ----------
    static : mapping
        Component -> static fields that it takes.
    maps : tuple of functions
        One for each transfer: outputs of both sides at the start and at the end of the window in
        which the giver summed its impulses -> inputs of the taker.
    moment : tuple of functions or None
        One for each transfer: the same and what was mapped -> the angular impulse about the
        origin (3,) N m s of what was mapped.
    """

    static: Mapping[str, Mapped]
    maps: tuple[Callable[[Ends, Ends], Mapped], ...]
    moment: tuple[Callable[[Ends, Ends, Fields], Array] | None, ...] = ()


class Link(ABC):
    """A kind of exchange between two components, matched to their ports: data, no state."""

    name: str  # in the scene
    transfers: tuple[Transfer, ...]  # what it carries, in either direction

    @property
    def ends(self) -> set[str]:
        """The components that it joins."""
        return {name for transfer in self.transfers for name in transfer.ends}

    def demands(self) -> Demands:
        """What it needs of steps and schemes; by default nothing: any steps, any scheme."""
        return Demands()

    def refusals(self, initial: Mapping[str, Fields]) -> list[str]:
        """Sentences about what it refuses of how its components begin.

        `initial` has, as far as they are known, each component's static fields and its instants at
        the start: the scene is checked by what manifests tell, and what is built once more.
        """
        return []

    def requests(self, described: Mapping[str, Fields]) -> Mapping[str, Fields]:
        """What components are to sample for it, by their names; see `Component.sample`."""
        return {}

    @abstractmethod
    def bind(self, described: Mapping[str, Fields]) -> Binding:
        """Make the maps, from what both sides describe and from the samples requested."""
