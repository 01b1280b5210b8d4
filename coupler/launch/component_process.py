"""A process of a component as the coupler has to do with it, from its start to its end."""

from dataclasses import dataclass

from quintet.coupler.launch.process_probe import ProcessProbe
from quintet.coupler.launch.processes import PROCESS, end_marked
from quintet.interfaces.lines.zenoh import ZenohLine


@dataclass(slots=True)
class ComponentProcess:
    """A process of a component, or the MPI job of its ranks, and the line to it.

    Parameters
    ----------
    joining : float, s
        Within which it must join.
    mark : str
        In the environment of the process, and of those that it starts.
    """

    line: ZenohLine
    probe: ProcessProbe
    joining: float
    mark: str

    def is_over(self) -> bool:
        """Whether it died, or its line is lost."""
        return not self.probe.alive() or self.line.partner_has_left()

    def end(self) -> None:
        """End what is left of it: other ranks, processes that it has started, and its line."""
        self.probe.end(0.0)
        end_marked(PROCESS, self.mark)
        self.line.leave()
