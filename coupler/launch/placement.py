"""Which node of a cluster each rank of a run should have."""

from collections.abc import Iterable
from dataclasses import dataclass

from quintet.interfaces.errors import SceneError


@dataclass(frozen=True, slots=True)
class Program:
    """A program of an MPI job: the coupler, or a component.

    Parameters
    ----------
    name : str
    threads : int
        Of each rank: the cores that it gets.
    ranks : int
    seconds : float, s
        Computing time of all its ranks on their cores, measured or planned.
    """

    name: str
    threads: int = 1
    ranks: int = 1
    seconds: float = 0.0

    @property
    def work(self) -> float:
        """Core-seconds of one rank."""
        return self.seconds * self.threads


def place(
    programs: Iterable[Program], nodes: int, cores: int | None = None
) -> dict[str, list[int]]:
    """Choose nodes for all ranks: the costliest first, each on the node with the least work.

    Parameters
    ----------
    programs : iterable of Program
        Where the work of nodes is equal, fewer cores and the lower number decide.
    nodes : int
    cores : int or None
        Of a node; None: as many as are asked for.

    Returns
    -------
    dict of list of int
        By program, the node of each rank, 0 to nodes - 1, ascending.

    Raises
    ------
    SceneError
        The ranks do not fit on the nodes, or are fewer than these.
    """
    work, used = [0.0] * nodes, [0] * nodes
    nodes_of: dict[str, list[int]] = {}
    for program in sorted(programs, key=lambda program: (-program.work, -program.threads)):
        nodes_of[program.name] = []
        for _ in range(program.ranks):
            room = [n for n in range(nodes) if cores is None or used[n] + program.threads <= cores]
            if not room:
                raise SceneError(_no_room(program, nodes, cores))
            node = min(room, key=lambda number: (work[number], used[number], number))
            work[node] += program.work
            used[node] += program.threads
            nodes_of[program.name].append(node)
    if empty := used.count(0):
        raise SceneError(
            f"--nodes must be at most the number of processes, {sum(map(len, nodes_of.values()))}; "
            f"found {nodes}, of which {empty} would be idle. Ask for fewer."
        )
    return {name: sorted(numbers) for name, numbers in nodes_of.items()}


def _no_room(program: Program, nodes: int, cores: int | None) -> str:
    return (
        f"--nodes: all ranks must fit on {nodes} nodes of {cores} cores; {program.name} needs "
        f"{program.threads} cores for each of its {program.ranks} ranks and finds none free. Ask "
        f"for more nodes, or set components.{program.name}.threads."
    )
