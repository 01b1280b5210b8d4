"""``quintet compile``: fill the caches of compiled kernels, so that the first run need not wait.

A scene is built and steps through one window in this process; nothing is written but the caches.
"""

import argparse
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from quintet.coupler.coupling.group import assemble
from quintet.coupler.coupling.judgement.checks import Judgement
from quintet.coupler.coupling.ledger import Ledger
from quintet.coupler.coupling.schedule import Coupling
from quintet.coupler.coupling.windows import Windows
from quintet.coupler.launch.connect import connect
from quintet.coupler.launch.process_probe import signal_text
from quintet.coupler.launch.processes import PYTHON
from quintet.coupler.launch.watchdog import Watchdog
from quintet.coupler.run.beginning import Start
from quintet.coupler.run.loop import run
from quintet.coupler.run.signals import StopRequest
from quintet.coupler.scene.read import library, load, parse
from quintet.coupler.scene.scene import Scene
from quintet.interfaces.component import Fields
from quintet.interfaces.errors import SceneError
from quintet.interfaces.manifest import known_kinds
from quintet.interfaces.params import unknown

QUICK = "quick"  # preset that is compiled where a scene has it: the kernels are the same


@dataclass(slots=True)
class OneWindow:
    """Observer of a run that ends after its first window and writes nothing."""

    done: bool = False

    def plan(self, windows: Windows) -> None:
        """See `Observer.plan`."""

    def begin(self, coupling: Coupling, described: Mapping[str, Fields]) -> None:
        """See `Observer.begin`."""

    def due(self, ticks: int) -> bool:
        """See `Observer.due`."""
        return True

    def end_window(self, coupling: Coupling) -> None:
        """See `Observer.end_window`."""
        for participant in coupling.components.values():
            participant.call("view")
        self.done = True

    def warn(self, text: str) -> None:
        """See `Observer.warn`."""

    def wants_end(self) -> bool:
        """See `Observer.wants_end`."""
        return self.done

    def ends_early(self, coupling: Coupling) -> None:
        """See `Observer.ends_early`."""


def compile_scene(scene: Scene) -> None:
    """Build all components of a scene in this process and step through one window."""
    watchdog = Watchdog(StopRequest(), in_main_thread=True, alone=len(scene.components) == 1)
    exchange = scene.exchange()
    with tempfile.TemporaryDirectory() as folder:
        connection = connect(scene, Path(folder), watchdog)
        try:
            ledger = Ledger(exchange)
            coupling = assemble(scene.coupling, connection.participants, exchange, ledger)
            asked, judgement = scene.asked_outputs(), Judgement(ledger.accounts)
            run(coupling, scene.file.end, OneWindow(), asked, judgement, start=Start(scene))
        finally:
            connection.close(False)


def run_compile(options: argparse.Namespace) -> int:
    """Compile one scene here, several in a process each."""
    if len(options.names) == 1 and options.names[0] not in known_kinds():
        preset = options.preset or _quick(options.names[0])
        began = time.perf_counter()
        scene = load(options.names[0], preset, options.settings, (), "memory")
        compile_scene(scene)
        print(f"{scene.headline}: compiled in {time.perf_counter() - began:.0f} s", flush=True)
        return 0
    if options.preset or options.settings:
        raise SceneError("compile: --preset and --set need one scene. Name one.")
    status = 0
    for name in scenes_of(options.names):
        command = [*PYTHON, "-m", "quintet.coupler.cli", "compile", name]
        code = subprocess.run(command, stdin=subprocess.DEVNULL).returncode
        if code < 0:
            print(f"quintet: compile {name} was killed by {signal_text(-code)}", file=sys.stderr)
            code = 128 - code  # as a shell counts
        status = max(status, code)
    return status


def scenes_of(names: list[str]) -> list[str]:
    """Scenes to compile: those named, and all shipped ones that use a kind that is named."""
    shipped, kinds = library(), known_kinds()
    wanted: dict[str, None] = {} if names else dict.fromkeys(shipped)
    for name in names:
        if name in kinds:
            uses = (scene for scene, path in shipped.items() if name in _kinds(path))
            wanted.update(dict.fromkeys(uses))
        elif name in shipped or Path(name).is_file():
            wanted[name] = None
        else:
            raise SceneError(unknown(f"compile {name}", name, [*shipped, *kinds]))
    return list(wanted)


def _kinds(path: Path) -> set[str]:
    return {component.get("kind", "") for component in parse(path).get("components", {}).values()}


def _quick(name: str) -> str:
    path = library().get(name, Path(name))
    return QUICK if path.is_file() and QUICK in parse(path).get("presets", {}) else ""
