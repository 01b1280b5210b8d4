"""Mutated scenes: each shipped one with types, numbers, keys, nesting or names gone wrong."""

import datetime
import math
import random
import shutil
import tomllib
from dataclasses import dataclass
from pathlib import Path

import tomli_w

from quintet.coupler.scene.read import library
from quintet.interfaces.manifest import known_kinds

NUMBERS = (
    0, 1, -1, 7, 2**31, 2**63, 10**25, 10**40, 0.0, -0.0, 1.0, -1.0, 1e-300, 1e-30, 1e-9, 1e9, 1e18,
    1e29, 1e30, 1e300, -1e300, 1.7e308, math.nan, math.inf, -math.inf,
)  # fmt: skip
OTHERS = (
    True, False, "", "x", "a.b", "..", "/dev/zero", "nan", "é\n\u0000", "x" * 5000, [], {}, [[]],
    [0.0, 0.0], [1.0, 2.0, 3.0, 4.0], [[0.0], 1.0], {"x": 1}, [{}], {"": {}}, ["a", 1],
    datetime.date(2020, 1, 1),
)  # fmt: skip
SETTINGS = ("components=5", "links=1", "expect={}", "groups.a.members=[]", "output=3", "presets=[]",
            "end=1e300", "window=nan", "order=[]", "study=1", "stability={}", "scan=[1]",
            "stand_ins=3",
            "tls=[]", "endpoint=tcp/127.0.0.1:0", "iteration.limit=0", "a.b=1", ".=1", "=",
            "expect.0.unit=mm", "expect.99.unit=m", "expect.².unit=m", "end=[[[[")  # fmt: skip


@dataclass(frozen=True)
class Mutant:
    """A scene file that was written, and the arguments that it is checked with."""

    name: str
    path: Path
    arguments: tuple[str, ...]


def mutants(folder: Path, count: int, seed: int):
    """Write mutated scenes, in turn of every shipped one; the same for the same seed."""
    generator = random.Random(seed)
    scenes = library()
    copies = {name: folder / name for name in scenes}
    for name, path in scenes.items():
        shutil.copytree(path.parent, copies[name], ignore=shutil.ignore_patterns("__pycache__"))
    for number in range(count):
        name = sorted(scenes)[number % len(scenes)]
        text = scenes[name].read_text(encoding="utf-8")
        path = copies[name] / f"scene_{number}.toml"
        draw = generator.random()
        if draw < 0.1:
            path.write_bytes(spoil(text, generator))
        else:
            table = tomllib.loads(text)
            for _ in range(generator.choice((1, 1, 1, 2, 3))):
                mutate(table, generator)
            path.write_text(tomli_w.dumps(table), encoding="utf-8")
        yield Mutant(f"{name} {number}", path, arguments(tomllib.loads(text), generator))


def spoil(text: str, generator: random.Random) -> bytes:
    """Change a scene as text: bytes, lines, its end."""
    data = bytearray(text.encode())
    place = generator.randrange(len(data))
    match generator.randrange(4):
        case 0:
            data[place] = generator.randrange(256)
        case 1:
            del data[place:]
        case 2:
            del data[place : place + generator.randrange(1, 40)]
        case _:
            data[place:place] = generator.choice(
                (b"[[", b"]]", b'"', b"=", b"\xff", b"0x", b"[" * 9999)
            )
    return bytes(data)


def arguments(table: dict, generator: random.Random) -> tuple[str, ...]:
    """Options that override a few values of a scene."""
    draw = generator.random()
    if draw < 0.06:
        return ("--set", generator.choice(SETTINGS))
    if draw < 0.1:
        kinds = [*known_kinds(), *table["components"], "replay@nowhere", "replay@.", ":", "os:path"]
        name = generator.choice([*table["components"], "nobody", ""])
        return ("--swap", f"{name}={generator.choice(kinds)}")
    if draw < 0.14:
        return ("--preset", generator.choice([*table.get("presets", {}), "quik"]))
    return ()


def places(container, path=()):
    """All places in nested tables and lists: their container and key."""
    pairs = (
        container.items()
        if isinstance(container, dict)
        else enumerate(container)
        if isinstance(container, list)
        else ()
    )
    for key, value in list(pairs):
        yield container, key
        yield from places(value, (*path, key))


def mutate(table: dict, generator: random.Random) -> None:
    """Change one place of a scene."""
    locations = list(places(table))
    if not locations:
        return
    container, key = generator.choice(locations)
    value = container[key]
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    match generator.randrange(10):
        case 0 | 1 if is_number:
            container[key] = generator.choice(NUMBERS)
        case 2 | 3 if is_number:
            container[key] = float(value) * 10.0 ** generator.uniform(-40.0, 40.0)
        case 4 if is_number:
            container[key] = -value
        case 0 | 5:
            container[key] = generator.choice((*NUMBERS, *OTHERS))
        case 1 | 6:
            del container[key]
        case 2 if isinstance(container, dict):
            container[misspelt(key, generator)] = container.pop(key)
        case 3 if isinstance(value, list) and value:
            repeated = value * generator.choice((2, 40))
            container[key] = generator.choice(
                (repeated, value[1:], value[:1], [*value, generator.choice(OTHERS)])
            )
        case 4 if isinstance(value, str):
            texts = [text for a, k in locations if isinstance(text := a[k], str)]
            container[key] = generator.choice((*texts, *known_kinds(), misspelt(value, generator)))
        case 7:
            container[key] = generator.choice(([value], {"x": value}, [[value], value]))
        case 8 if isinstance(container, dict):
            container[generator.choice(("extra", "kind", "name", "position", "x" * 300))] = value
        case _:
            other_container, place = generator.choice(locations)
            if (
                place in other_container
                if isinstance(other_container, dict)
                else place < len(other_container)
            ):
                container[key], other_container[place] = (
                    copy_of(other_container[place]),
                    copy_of(value),
                )


def copy_of(value):
    """Copy of a value: swapped into itself it would have no end."""
    if isinstance(value, dict):
        return {key: copy_of(entry) for key, entry in value.items()}
    return [copy_of(entry) for entry in value] if isinstance(value, list) else value


def misspelt(word: str, generator: random.Random) -> str:
    """A word with a letter changed, or doubled."""
    if not word:
        return "x"
    place = generator.randrange(len(word))
    return word[:place] + generator.choice(("x", "", word[place] * 2, ".", " ")) + word[place + 1 :]
