"""Reading a scene: TOML, a preset, what the command line sets; every mistake at once."""

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import fields
from functools import partial
from importlib.resources import files
from itertools import islice
from pathlib import Path
from typing import Any

from quintet.coupler.measures.evaluation import check
from quintet.coupler.measures.expectation import Expectation
from quintet.coupler.scene.begin_table import Beginning, beginning_of
from quintet.coupler.scene.component_tables import read_components, require_components
from quintet.coupler.scene.foreign_code import announce, trusted_tables
from quintet.coupler.scene.groups import (
    begins_wrong,
    lay_out,
    nothing_to_watch,
    refused,
    unknown_outputs,
)
from quintet.coupler.scene.link_tables import read_links
from quintet.coupler.scene.material_names import with_materials
from quintet.coupler.scene.needs import refused_times
from quintet.coupler.scene.overrides import put_preset, put_set
from quintet.coupler.scene.quantity_texts import scene_in_si, value_in_si
from quintet.coupler.scene.scene import (
    ComponentPlan,
    Scene,
    SceneFile,
    import_folders,
    kinds_of,
    wrong_name,
)
from quintet.coupler.scene.stability_checks import Scope
from quintet.coupler.scene.swap import put_swap
from quintet.coupler.scene.tables import SceneTables
from quintet.coupler.scene.toml import read_file, too_many
from quintet.coupler.scene.variants import LISTS, VARIED, Variants, read_variants
from quintet.coupler.scene.varied_tables import read_tables
from quintet.interfaces.errors import LineError, SceneError
from quintet.interfaces.lines.endpoint import Security, check_endpoint
from quintet.interfaces.manifest import look_in
from quintet.interfaces.params import extremes, read, shown, unknown

MOST_TOLD = 20  # mistakes of one kind
TABLES = tuple(field.name for field in fields(SceneTables))


def library() -> dict[str, Path]:
    """Scenes that come with quintet: name and file."""
    root = Path(str(files("quintet.scenarios")))
    return {path.parent.name: path for path in sorted(root.glob("*/scene.toml"))}


def locate(scene: str) -> Path:
    """File of a scene given by name or by path."""
    if scene.endswith(".toml") or "/" in scene:
        path = Path(scene)
        path = path / "scene.toml" if path.is_dir() else path
        if not path.is_file():
            raise SceneError(f"scene {scene}: there is no such file. Give a name or a path.")
        return path
    known = library()
    if scene not in known:
        raise SceneError(unknown(f"scene {scene}", scene, known))
    return known[scene]


def load(
    scene: str,
    preset: str = "",
    settings: Iterable[str] = (),
    swaps: Iterable[str] = (),
    transport: str = "",
    imports: bool = True,
) -> Scene:
    """Read a scene and check all of it; nothing is started.

    Parameters
    ----------
    scene : str
        A name from ``quintet list`` or the path of a TOML file.
    settings : iterable of ``path=value``
        Set on top of the preset; values are TOML.
    swaps : iterable of ``NAME=KIND``
        Components to be replaced by another kind.
    imports : bool
        Whether code of the scene's own may be imported, as a run does: kinds ``module:Class``.
        Without it their keys and ports are not checked.

    Raises
    ------
    SceneError
        With every mistake found.
    """
    settings = list(settings)
    # Variants need not suit settings of a run that belongs to none of them.
    return _load(scene, preset, settings, swaps, transport, not settings, imports)[0]


def load_variants(
    scene: str,
    preset: str = "",
    settings: Iterable[str] = (),
    swaps: Iterable[str] = (),
    transport: str = "",
) -> tuple[Scene, Variants]:
    """Read a scene with its refinements, limits, scans and ensemble, which must suit it."""
    return _load(scene, preset, list(settings), swaps, transport, True, True)


def _load(
    scene: str,
    preset: str,
    settings: list[str],
    swaps: Iterable[str],
    transport: str,
    with_variants: bool,
    imports: bool,
) -> tuple[Scene, Variants]:
    path, swaps = locate(scene), list(swaps)
    table = parse(path)
    mistakes = put_preset(table, preset) if preset else []
    for swap in swaps:
        mistakes += put_swap(table, swap)
    for setting in settings:
        mistakes += put_set(table, setting)
    if transport:
        table["transport"] = transport
    mistakes = mistakes or too_many(table)
    if mistakes := mistakes or list(islice(extremes(table, ""), MOST_TOLD)):
        raise SceneError([f"{path.name}: {mistake}" for mistake in mistakes])
    # Variants are written for the components of the file: with a swap each is checked when it runs.
    checked, variants = _check(path, table, preset, not swaps, with_variants, imports)
    changes = {"preset": preset, "settings": settings, "swaps": swaps}
    checked.asked = {"scene": str(path.resolve()), "transport": transport, **changes}
    return checked, variants


def parse(path: Path) -> dict[str, Any]:
    """Read a TOML file as it stands."""
    return read_file(path)


def _check(
    path: Path,
    table: dict[str, Any],
    preset: str,
    try_variants: bool = True,
    with_variants: bool = True,
    imports: bool = True,
) -> tuple[Scene, Variants]:
    tables = table.get("components")
    tables = tables if imports else trusted_tables(tables, path.parent)
    look_in(import_folders(path, tables))
    announce(kinds_of(tables), path.parent)
    table = _with_constants(path, table, imports)
    keys = {key: value for key, value in table.items() if key not in TABLES}
    file, mistakes = read(SceneFile, keys, "scene")
    mistakes = [_also_tables(mistake) for mistake in mistakes]
    component_tables = require_components(path, table, mistakes)
    link_tables = _tables(table, "links", mistakes)
    beginning = _beginning(table, path.parent, mistakes)
    begun = beginning.components if beginning else ()
    components = read_components(
        component_tables, path.parent, mistakes, imports, link_tables, begun
    )
    wrong = set(component_tables) - set(components)  # their mistakes are known already
    unread = {name for name, plan in components.items() if plan.unread}
    links = read_links(link_tables, components, wrong | unread, mistakes)
    expect = _expect(_tables(table, "expect", mistakes), components, wrong, path.parent, mistakes)
    coupling = None
    if file is not None:
        if not wrong:
            coupling = lay_out(file, table.get("groups", {}), components, mistakes)
        if coupling and not mistakes:
            components = {name: components[name] for name in coupling.components()}
            mistakes += refused(coupling, components, links)
            mistakes += unknown_outputs(file, components)
            mistakes += nothing_to_watch(file, links, expect)
            mistakes += refused_times(file, components, coupling, links)
            mistakes += [] if mistakes else begins_wrong(components, links, expect)
        if file.window != "auto" and file.window > file.end:
            mistakes.append(
                f"scene.window must not exceed scene.end ({file.end:g} s); found {file.window:g} s."
                " Shorten it."
            )
        mistakes += _reachable(file) + wrong_name(file.name) + _alone(file, components)
    series = {key: _tables(table, key, mistakes) for key in LISTS}
    series = series if with_variants else {key: [] for key in series}
    scope, check = None, None
    if file is not None and not mistakes:
        gives = {name: plan.gives for name, plan in components.items()}
        expected = {expectation.name: expectation for expectation in expect}
        scope = Scope(file.end, gives, len(links), expected, frozenset(unread))
        check = partial(_check, path, preset=preset, imports=imports) if try_variants else None
    si = partial(value_in_si, table, path.parent, imports)
    variants, wrong_variants = read_variants(series, table, check, scope, preset, with_variants, si)
    mistakes += wrong_variants
    if mistakes or file is None or coupling is None:
        raise SceneError([f"{path.name}: {mistake}" for mistake in dict.fromkeys(mistakes)])
    resolved = {k: v for k, v in table.items() if k not in ("presets", *VARIED)}
    scene = Scene(file, path, preset, components, links, coupling, expect, resolved, file.transport)
    scene.beginning = beginning
    return scene, variants


def _with_constants(path: Path, table: dict[str, Any], imports: bool) -> dict[str, Any]:
    """Write constants for the names of materials, and plain numbers for quantities with units."""
    table, wrong_texts = with_materials(table, path.parent, imports)
    if not wrong_texts:
        table, wrong_texts = scene_in_si(table, path.parent, imports)
    if wrong_texts:
        raise SceneError([f"{path.name}: {mistake}" for mistake in wrong_texts[:MOST_TOLD]])
    return table


def _beginning(table: dict[str, Any], folder: Path, mistakes: list[str]) -> Beginning | None:
    """Find the state of another run that a scene begins from, if it does."""
    try:
        return beginning_of(table, folder)
    except SceneError as error:
        mistakes.append(str(error))
        return None


def _also_tables(mistake: str) -> str:
    """Where a top-level name is unknown, the tables are known names too."""
    head, known, _ = mistake.partition(" is not known.")
    name = head.removeprefix("scene.")
    if known and "." not in name:
        return unknown(head, name, [*SceneFile.__dataclass_fields__, *TABLES])
    return mistake


def _alone(file: SceneFile, components: Mapping[str, ComponentPlan]) -> list[str]:
    """Refuse what needs processes that end alone, over a transport that has none."""
    mistakes = [
        f"components.{name}.ranks must be 1 over the transport memory, which is one process; found "
        f"{plan.ranks}. Choose the transport mpi or zenoh."
        for name, plan in components.items()
        if plan.ranks > 1 and file.transport == "memory"
    ]
    if file.restarts and file.transport != "zenoh":
        mistakes.append(
            f"scene.restarts must be 0 over the transport {file.transport}, where all processes "
            f"end with the first that dies; found {file.restarts}. Choose the transport zenoh, or "
            "set restarts=0."
        )
    return mistakes


def _reachable(file: SceneFile) -> list[str]:
    """Check the endpoint of the coupler and its certificate files."""
    if len(file.tls) not in (0, 3):
        return [
            "scene.tls must be three files: authority, certificate, key; found "
            f"{len(file.tls)}. Name all three."
        ]
    wrong = [
        f"scene.tls: {name} is not there. Make the file, or correct its path."
        for name in file.tls
        if not Path(name).is_file()
    ]
    if file.endpoint:
        try:
            check_endpoint(file.endpoint, Security(*file.tls) if file.tls else None)
        except LineError as error:
            wrong.append(f"scene.{error}")
    return wrong


def _tables(table: dict[str, Any], key: str, mistakes: list[str]) -> list[dict[str, Any]]:
    """Return what must be a list of tables, or nothing."""
    tables = table.get(key, [])
    if isinstance(tables, list) and all(isinstance(table, dict) for table in tables):
        return tables
    mistakes.append(f"{key} must be a list of tables; found {shown(tables)}. Write [[{key}]].")
    return []


def _expect(
    tables: list[dict[str, Any]],
    components: dict[str, ComponentPlan],
    wrong: set[str],
    folder: Path,
    mistakes: list[str],
) -> list[Expectation]:
    expectations = []
    gives = {name: plan.gives for name, plan in components.items()}
    for _, expectation in read_tables(Expectation, "expect", "name", tables, mistakes):
        name = expectation.component
        if name not in wrong:
            is_read = name not in components or not components[name].unread
            mistakes += check(expectation, gives, folder) if is_read else []
            expectations.append(expectation)
    for name, count in Counter(expectation.name for expectation in expectations).items():
        if count > 1:  # results and studies know an expectation by its name alone
            mistakes.append(f"expect: {count} have the name {shown(name)}. Give each its own.")
    return expectations
