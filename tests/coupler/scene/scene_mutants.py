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
    chosen = random.Random(seed)
    scenes = library()
    copies = {name: folder / name for name in scenes}
    for name, path in scenes.items():
        shutil.copytree(path.parent, copies[name], ignore=shutil.ignore_patterns("__pycache__"))
    for number in range(count):
        name = sorted(scenes)[number % len(scenes)]
        text = scenes[name].read_text(encoding="utf-8")
        path = copies[name] / f"scene_{number}.toml"
        way = chosen.random()
        if way < 0.1:
            path.write_bytes(spoil(text, chosen))
        else:
            table = tomllib.loads(text)
            for _ in range(chosen.choice((1, 1, 1, 2, 3))):
                mutate(table, chosen)
            path.write_text(tomli_w.dumps(table), encoding="utf-8")
        yield Mutant(f"{name} {number}", path, arguments(tomllib.loads(text), chosen))


def spoil(text: str, chosen: random.Random) -> bytes:
    """Change a scene as text: bytes, lines, its end."""
    raw = bytearray(text.encode())
    place = chosen.randrange(len(raw))
    match chosen.randrange(4):
        case 0:
            raw[place] = chosen.randrange(256)
        case 1:
            del raw[place:]
        case 2:
            del raw[place : place + chosen.randrange(1, 40)]
        case _:
            raw[place:place] = chosen.choice(
                (b"[[", b"]]", b'"', b"=", b"\xff", b"0x", b"[" * 9999)
            )
    return bytes(raw)


def arguments(table: dict, chosen: random.Random) -> tuple[str, ...]:
    """Overrides of a few of them."""
    way = chosen.random()
    if way < 0.06:
        return ("--set", chosen.choice(SETTINGS))
    if way < 0.1:
        kinds = [*known_kinds(), *table["components"], "replay@nowhere", "replay@.", ":", "os:path"]
        swapped = chosen.choice([*table["components"], "nobody", ""])
        return ("--swap", f"{swapped}={chosen.choice(kinds)}")
    if way < 0.14:
        return ("--preset", chosen.choice([*table.get("presets", {}), "quik"]))
    return ()


def places(at, path=()):
    """All places in nested tables and lists: their container and key."""
    pairs = at.items() if isinstance(at, dict) else enumerate(at) if isinstance(at, list) else ()
    for key, value in list(pairs):
        yield at, key
        yield from places(value, (*path, key))


def mutate(table: dict, chosen: random.Random) -> None:
    """Change one place of a scene."""
    found = list(places(table))
    if not found:
        return
    at, key = chosen.choice(found)
    value = at[key]
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    match chosen.randrange(10):
        case 0 | 1 if is_number:
            at[key] = chosen.choice(NUMBERS)
        case 2 | 3 if is_number:
            at[key] = float(value) * 10.0 ** chosen.uniform(-40.0, 40.0)
        case 4 if is_number:
            at[key] = -value
        case 0 | 5:
            at[key] = chosen.choice((*NUMBERS, *OTHERS))
        case 1 | 6:
            del at[key]
        case 2 if isinstance(at, dict):
            at[misspelt(key, chosen)] = at.pop(key)
        case 3 if isinstance(value, list) and value:
            more = value * chosen.choice((2, 40))
            at[key] = chosen.choice((more, value[1:], value[:1], [*value, chosen.choice(OTHERS)]))
        case 4 if isinstance(value, str):
            words = [one for a, k in found if isinstance(one := a[k], str)]
            at[key] = chosen.choice((*words, *known_kinds(), misspelt(value, chosen)))
        case 7:
            at[key] = chosen.choice(([value], {"x": value}, [[value], value]))
        case 8 if isinstance(at, dict):
            at[chosen.choice(("extra", "kind", "name", "position", "x" * 300))] = value
        case _:
            other, place = chosen.choice(found)
            if place in other if isinstance(other, dict) else place < len(other):
                at[key], other[place] = plain(other[place]), plain(value)


def plain(value):
    """Copy of a value: swapped into itself it would have no end."""
    if isinstance(value, dict):
        return {key: plain(one) for key, one in value.items()}
    return [plain(one) for one in value] if isinstance(value, list) else value


def misspelt(word: str, chosen: random.Random) -> str:
    """A word with a letter changed, or doubled."""
    if not word:
        return "x"
    place = chosen.randrange(len(word))
    return word[:place] + chosen.choice(("x", "", word[place] * 2, ".", " ")) + word[place + 1 :]
