"""What a scene shows at its start: all components are built and joined here, and none steps."""

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from quintet.coupler.coupling.group import assemble
from quintet.coupler.coupling.judgement.checks import Judgement
from quintet.coupler.coupling.ledger import Ledger
from quintet.coupler.coupling.schedule import Coupling
from quintet.coupler.coupling.windows import Windows
from quintet.coupler.files.run_files import view_file, walls_file
from quintet.coupler.files.vtkhdf import VtkHdf
from quintet.coupler.launch.connect import connect
from quintet.coupler.launch.watchdog import Watchdog
from quintet.coupler.run.loop import run
from quintet.coupler.run.output import WALLS
from quintet.coupler.run.signals import StopRequest
from quintet.coupler.scene.scene import Scene
from quintet.interfaces.component import Fields


@dataclass(slots=True)
class FirstView:
    """Observer of a run that ends before its first window and writes what there is to see."""

    folder: Path
    title: str
    shown: list[str] = field(default_factory=list)  # components that have something to show

    def plan(self, windows: Windows) -> None:
        """See `Observer.plan`."""

    def begin(self, coupling: Coupling, described: Mapping[str, Fields]) -> None:
        """Write the views of all components, and what stands still around them."""
        for name, participant in coupling.components.items():
            answer = participant.call("view", shown=True, walls=True)
            view = {k: v for k, v in answer.fields.items() if not k.startswith(WALLS)}
            walls = {k.removeprefix(WALLS): v for k, v in answer.fields.items() if k not in view}
            if "points" in view:
                self.shown.append(name)
                self._write(view_file(name), view, answer.header["units"])
            if "points" in walls:
                self._write(walls_file(name), walls, {})

    def _write(self, name: str, fields: Fields, units: Mapping[str, str]) -> None:
        file = VtkHdf(self.folder / name, units, self.title)
        file.append(0.0, fields)
        file.close()

    def due(self, ticks: int) -> bool:
        """See `Observer.due`."""
        return False

    def end_window(self, coupling: Coupling) -> None:
        """See `Observer.end_window`."""

    def warn(self, text: str) -> None:
        """See `Observer.warn`."""

    def wants_end(self) -> bool:
        """See `Observer.wants_end`."""
        return True

    def ends_early(self, coupling: Coupling) -> None:
        """See `Observer.ends_early`."""


def write_first_view(scene: Scene, folder: Path) -> list[str]:
    """Write what a scene, over memory, shows at its start; return the components that do.

    Parameters
    ----------
    scene
        With transport memory.
    folder : Path
        That the files of views are written into.
    """
    watchdog = Watchdog(StopRequest(), in_main_thread=True, alone=len(scene.components) == 1)
    exchange, observer = scene.exchange(), FirstView(folder, scene.headline)
    with tempfile.TemporaryDirectory() as place:
        connection = connect(scene, Path(place), watchdog)
        try:
            ledger = Ledger(exchange)
            coupling = assemble(scene.coupling, connection.participants, exchange, ledger)
            judgement = Judgement(ledger.accounts)
            run(coupling, scene.file.end, observer, scene.asked_outputs(), judgement)
        finally:
            connection.close(False)
    return observer.shown
