"""``quintet describe``: every key with its meaning, unit, type, range and default."""

import argparse
import json
import re
import shutil
import sys
import textwrap
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from quintet.coupler.files.disk import write_whole
from quintet.coupler.reference.sections import (
    Reference,
    Section,
    first_line,
    ports_of_cases,
    reference_of,
    subjects,
)
from quintet.interfaces.component import port_text
from quintet.interfaces.errors import SceneError
from quintet.interfaces.keys import Key
from quintet.interfaces.manifest import find, known_kinds
from quintet.interfaces.params import unknown
from quintet.interfaces.quantities import is_in_si

PLACE = re.compile(r"(<!-- describe ([^>]+?) -->\n).*?(<!-- described -->)", re.DOTALL)
TEXTS = 'numbers that have a unit may be texts with a unit of the same dimension, as "20 mm"'
HEADS = ("key", "unit", "type", "default", "meaning")


def run_describe(options: argparse.Namespace) -> int:
    """Print what a scene, a kind or a link may say, or write it into texts."""
    if options.write:
        if options.subject or options.json:
            raise SceneError(
                "describe --write takes its subjects from the files, and writes Markdown. Remove "
                "SUBJECT and --json."
            )
        for path in options.write:
            write_whole(path, filled(_text_of(path), str(path)))
        return 0
    if not options.subject:
        rows = list(subjects())
        room = max(len(name) for name, _ in rows)
        listed = [{"subject": name, "title": title} for name, title in rows]
        plain = "\n".join(f"{name:<{room}}  {title}" for name, title in rows)
        print(_json(listed) if options.json else plain)
        return 0
    reference, part = chosen(options.subject)
    section = part_of(reference, part) if part else None
    tables = [section] if section else reference.sections
    if options.json:
        print(_json([as_data(section) for section in tables]))
        return 0
    width = shutil.get_terminal_size().columns if sys.stdout.isatty() else None
    print("\n".join(section_lines(section, width) if section else lines(reference, width)))
    return 0


def _text_of(path: Path) -> str:
    """Text of a file into which tables are written."""
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise SceneError(f"--write {path}: it cannot be read ({error}). Name another.") from error


def _json(content: object) -> str:
    return json.dumps(content, indent=2, ensure_ascii=False)


def chosen(words: list[str]) -> tuple[Reference, str]:
    """Return what the words name, and the table or key in it if they go on to one."""
    count = 2 if words[0] == "link" else 1
    if words[0] == "link" and len(words) == 1:
        raise SceneError("describe link needs a kind of link. Name one, as in describe link fsi.")
    if len(words) > count + 1:
        raise SceneError(f"describe: one subject at a time; found {' '.join(words)}. Name one.")
    return reference_of(*words[:count]), "".join(words[count:])


def part_of(reference: Reference, part: str) -> Section:
    """One table of a reference, or a table with one key, by its path."""
    tables = {".".join(section.path): section for section in reference.sections}
    if part in tables:
        return tables[part]
    rows = {
        ".".join([*section.path, key.name]): replace(section, about="", keys=(key,))
        for section in reference.sections
        for key in section.keys
    }
    if part not in rows:
        known = [*tables, *rows]
        raise SceneError(unknown(f"describe {reference.name}: {part}", part, filter(None, known)))
    return rows[part]


def lines(reference: Reference, width: int | None) -> Iterator[str]:
    """Write a reference as lines, its texts wrapped at a width if one is given."""
    yield f"{reference.name}: {reference.title}"
    sides = ports_of_cases(reference.name) if reference.name in known_kinds() else ((), ())
    for verb, ports in zip(("takes", "gives"), sides, strict=True):
        for port in ports:
            yield from _wrapped(f"{verb} {port_text(port)}", width, "")
    if reference.name in known_kinds() and find(reference.name).ranks:
        yield "may own several MPI ranks (key `ranks`)"
    if any(key.numeric and is_in_si(key.unit) for part in reference.sections for key in part.keys):
        yield TEXTS
    for section in reference.sections:
        yield ""
        same = first_line(section.about) == reference.title
        yield from section_lines(replace(section, about="") if same else section, width)


def section_lines(section: Section, width: int | None) -> Iterator[str]:
    """Write one table as lines: two for each key, what it may be and what it means."""
    if section.head:
        yield section.head
    if section.about:
        yield from _wrapped(section.about, width, "")
        yield ""
    rows = [(key.name, key.unit, may_be(key), default(key)) for key in section.keys]
    widths = [max((len(row[n]) for row in rows), default=0) for n in range(3)]
    for row, key in zip(rows, section.keys, strict=True):
        parts = [f"{part:<{room}}" for part, room in zip(row, widths, strict=False)]
        yield "  ".join([*parts, row[-1]]).rstrip()
        yield from _wrapped(key.meaning, width, "    ")


def _wrapped(text: str, width: int | None, indent: str) -> Iterator[str]:
    for part in filter(None, text.split("\n\n")):
        line = indent + " ".join(part.split())
        yield from textwrap.wrap(line, width, subsequent_indent=indent) if width else [line]


def may_be(key: Key) -> str:
    """Type and range."""
    return f"{key.words}, {key.range}" if key.range else key.words


def default(key: Key) -> str:
    """What holds where the key is left out."""
    return "needed" if key.needed else key.default


def as_data(section: Section) -> dict[str, object]:
    """One table, for programs."""
    names = ("unit", "range", "default", "needed", "meaning")
    rows = [
        {"key": key.name, "type": key.words, **{name: getattr(key, name) for name in names}}
        for key in section.keys
    ]
    return {"table": section.head, "about": section.about, "keys": rows}


def markdown(reference: Reference) -> Iterator[str]:
    """Write a reference as tables of Markdown."""
    for section in reference.sections:
        if section.head:
            about = " ".join(section.about.split("\n\n")[0].split())
            yield f"`{section.head}`: {about}" if about else f"`{section.head}`:"
            yield ""
        yield f"| {' | '.join(HEADS)} |"
        yield f"|{len(HEADS) * '---|'}"
        for key in section.keys:
            row = (f"`{key.name}`", key.unit, may_be(key), _cell_of_default(key), key.meaning)
            yield f"| {' | '.join(cell.replace('|', '&#124;') for cell in row)} |"
        yield ""


def _cell_of_default(key: Key) -> str:
    if key.needed:
        return "**needed**"
    return f"`{key.default}`" if key.default not in ("", "none") else key.default


def filled(text: str, where: str) -> str:
    """Fill in the tables of a text, each between ``describe SUBJECT`` and ``described``."""

    def tables(place: re.Match[str]) -> str:
        reference, _ = chosen(place[2].split())
        return place[1] + "\n" + "\n".join(markdown(reference)) + place[3]

    if not PLACE.search(text):
        raise SceneError(
            f"{where}: there is no place for tables. Write <!-- describe SUBJECT --> and "
            "<!-- described --> on lines of their own."
        )
    return PLACE.sub(tables, text)
