"""Other programs run in turns with the refinements of a study, so that all meet the same load."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from quintet.coupler.report.work_precision import COSTS
from quintet.coupler.study.peers.peer import Peer, load_of_machine
from quintet.interfaces.errors import SceneError

Row = dict[str, Any]
CHANGES = {"preset": "--preset", "settings": "--set", "swap": "--swap"}


@dataclass(slots=True)
class Beside:
    """The programs of ``--beside`` and what their runs gave."""

    peers: list[Peer]
    series: Path  # folder of the study
    stop: Callable[[], bool]
    keep: bool
    rows: dict[str, list[Row]] = field(default_factory=dict)

    def turn(self, number: int, refinements: int) -> None:
        """Do the runs of every program that follow refinement `number` of so many.

        The runs of a program are spread evenly over the refinements, be they more or fewer.
        """
        for peer in self.peers:
            for run in range(len(peer.runs)):
                if run * refinements // len(peer.runs) == number and not self.stop():
                    self._run(peer, run)

    def summary(self) -> Row:
        """What ``study.json`` has of them: nothing where there is none."""
        peers = [peer.summary(self.rows.get(peer.name, [])) for peer in self.peers]
        return {"peers": peers} if peers else {}

    def load(self) -> Row:
        """Load and cores of the machine as a run begins, kept where programs are compared."""
        return load_of_machine() if self.peers else {}

    def _run(self, peer: Peer, number: int) -> None:
        run = peer.runs[number]
        label = f"{peer.name}, {run.label}"
        print(f"{label}: in {peer.place(self.series, run)}", flush=True)
        row = peer.row(run, self.series, self.stop, self.keep)
        self.rows.setdefault(peer.name, []).append(row)
        cause = f": {row['cause']}" if row["cause"] else ""
        print(
            f"{label}: {row['status']}, {row['cpu']:.3g} s of {COSTS[peer.table.cost]}{cause}",
            flush=True,
        )


def refuse_changes(options: Any) -> None:
    """Refuse changes of the scene beside programs whose inputs do not follow them."""
    changed = [option for name, option in CHANGES.items() if getattr(options, name)]
    if options.beside and changed:
        raise SceneError(
            f"--beside takes no {', '.join(changed)}: the inputs of other programs are those of "
            "the scene as it stands. Remove it."
        )
