"""Keys of a scene, a kind of component or a kind of link, table by table."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

from quintet.coupler.coupling.links import known_links, maker
from quintet.coupler.scene.kinds import named_kind
from quintet.coupler.scene.scene import SceneFile
from quintet.coupler.scene.tables import SceneTables
from quintet.interfaces.component import Port
from quintet.interfaces.errors import SceneError
from quintet.interfaces.keys import Key, about, keys
from quintet.interfaces.manifest import Ports, known_kinds
from quintet.interfaces.params import read, unknown

SCENE_TITLE = "the keys of a scene file"


@dataclass(frozen=True, slots=True)
class Section:
    """One table: where it stands, what it is, and its keys."""

    path: tuple[str, ...]  # names of the tables around it, and its own
    several: bool  # whether it is one of a list
    about: str
    keys: tuple[Key, ...]

    @property
    def head(self) -> str:
        """The table's head as TOML has it; "" of the outermost."""
        name = ".".join(self.path)
        return f"[[{name}]]" if self.several else f"[{name}]" if name else ""


@dataclass(frozen=True, slots=True)
class Reference:
    """All tables of a scene, a kind or a link; the first is the outermost."""

    name: str
    title: str
    sections: tuple[Section, ...]


def reference_of(subject: str, kind: str = "") -> Reference:
    """Return what there is to know of ``scene``, of ``link`` and its kind, or of a component."""
    if subject == "scene":
        return Reference("scene", SCENE_TITLE, scene_sections())
    if subject == "link":
        params = link_keys(kind)
        return Reference(f"link {kind}", first_line(about(params)), tuple(sections(params)))
    manifest = named_kind(subject, "describe")
    return Reference(subject, manifest.title, tuple(sections(manifest.params)))


def ports_of_cases(kind: str) -> Ports:
    """Ports that a kind has with the parameters of any of its cases for ``quintet conform``."""
    manifest = named_kind(kind, "describe")
    takes: dict[str, Port] = {}
    gives: dict[str, Port] = {}
    for case in manifest.conform_cases() if manifest.conform else ():
        if isinstance(case.params, dict):  # others make files
            params, _ = read(manifest.params, case.params, manifest.kind)
            for known, ports in zip((takes, gives), manifest.ports(params), strict=True):
                for port in ports:
                    fields = {field.name: field for field in known.get(port.name, port).fields}
                    fields |= {field.name: field for field in port.fields}
                    known[port.name] = replace(port, fields=tuple(fields.values()))
    return tuple(takes.values()), tuple(gives.values())


def link_keys(kind: str) -> type:
    """Return the parameter class of a kind of link."""
    if kind not in known_links():
        raise SceneError(unknown(f"describe link {kind}", kind, known_links()))
    return maker(kind).keys


def scene_sections() -> tuple[Section, ...]:
    """Return the tables of a scene; those of kinds are told with the kinds."""
    file, *inner = sections(SceneFile)
    seen = dict(heads(SceneFile))
    tables, *outer = sections(SceneTables, seen=seen)
    top = Section((), False, "", file.keys + tables.keys)
    return (top, *inner, *outer)


def sections(
    params: type,
    path: tuple[str, ...] = (),
    several: bool = False,
    seen: dict[type, str] | None = None,
) -> Iterator[Section]:
    """Yield the table of a parameter class, and those within; each class once."""
    seen = {} if seen is None else seen
    rows: list[Key] = []
    within: list[tuple[type, tuple[str, ...], bool]] = []
    for key in keys(params):
        if (inner := key.inner) is not None:
            where = (*path, key.name, *(("NAME",) if key.place == "names" else ()))
            if known := seen.get(inner):
                key = replace(key, meaning=f"{key.meaning} Keys as in `{known}`.")
            else:
                listed = key.place == "list"
                seen[inner] = Section(where, listed, "", ()).head
                within.append((inner, where, listed))
        rows.append(key)
    yield Section(path, several, about(params), tuple(rows))
    for inner, where, listed in within:
        yield from sections(inner, where, listed, seen)


def heads(params: type) -> Iterator[tuple[type, str]]:
    """Yield the classes of the tables within a class, with the heads of their tables."""
    for key in keys(params):
        if key.inner is not None:
            yield key.inner, Section((key.name,), key.place == "list", "", ()).head
            yield from heads(key.inner)


def subjects() -> Iterator[tuple[str, str]]:
    """Yield all that can be described, each with its title; what cannot be imported says so."""
    yield "scene", SCENE_TITLE
    for kind in sorted(known_kinds()):
        yield kind, _title(kind)
    for kind in sorted(known_links()):
        yield f"link {kind}", _title("link", kind)


def _title(*subject: str) -> str:
    try:
        return reference_of(*subject).title
    except SceneError as error:
        return str(error)


def first_line(text: str) -> str:
    """First line of a text, without its stop."""
    return text.partition("\n")[0].removesuffix(".")
