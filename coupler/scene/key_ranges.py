"""``--over KEY=LOW:HIGH``: numbers of a scene that a calibration varies, and between what."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import shown

EXAMPLE = "Give it as in --over components.cubes.pairs.0.friction=0.05:0.45."


@dataclass(frozen=True, slots=True)
class KeyRange:
    """One number that is sought; several keys of the scene may take it."""

    keys: tuple[str, ...]
    low: float
    high: float

    @property
    def name(self) -> str:
        """Keys as they were given."""
        return ",".join(self.keys)

    @property
    def text(self) -> str:
        """The range as the command line has it."""
        return f"{self.name}={self.low!r}:{self.high!r}"

    def settings(self, value: float) -> dict[str, float]:
        """Settings by dotted path."""
        return dict.fromkeys(self.keys, value)


def read_ranges(options: Iterable[str]) -> list[KeyRange]:
    """Read ``KEY=LOW:HIGH`` or ``KEY,KEY=LOW:HIGH``; every mistake at once."""
    pairs: list[tuple[str, tuple[float, ...]]] = []
    mistakes: list[str] = []
    for option in options:
        keys, equals, text = option.rpartition("=")
        ends = tuple(map(_number, text.split(":")))
        if not (keys and equals) or len(ends) != 2 or not all(map(math.isfinite, ends)):
            mistakes.append(f"--over needs KEY=LOW:HIGH; found {shown(option)}. {EXAMPLE}")
            continue
        pairs.append((keys, ends))
    if mistakes:
        raise SceneError(mistakes)
    return ranges_of(dict(pairs)) if len(dict(pairs)) == len(pairs) else _refuse_twice(pairs)


def ranges_of(over: Mapping[str, Iterable[float]]) -> list[KeyRange]:
    """Ranges of a mapping of keys, with commas between those that take the same number."""
    ranges: list[KeyRange] = []
    mistakes: list[str] = []
    for names, ends in over.items():
        low_high = tuple(ends)
        if len(low_high) != 2 or not low_high[0] < low_high[1]:
            mistakes.append(
                f"--over {names}: LOW must be below HIGH; found {low_high}. Exchange them."
            )
            continue
        low, high = low_high
        keys = tuple(name.strip() for name in names.split(",") if name.strip())
        ranges.append(KeyRange(keys, float(low), float(high)))
    all_keys = [key for span in ranges for key in span.keys]
    mistakes += [
        f"--over {key}: a key must be given once; found it {all_keys.count(key)} times. Remove one."
        for key in dict.fromkeys(all_keys)
        if all_keys.count(key) > 1
    ]
    if not over:
        mistakes.append(f"calibrate needs a key to vary; found none. {EXAMPLE}")
    if mistakes:
        raise SceneError(mistakes)
    return ranges


def _refuse_twice(pairs: list[tuple[str, tuple[float, ...]]]) -> list[KeyRange]:
    names = [keys for keys, _ in pairs]
    twice = next(keys for keys in names if names.count(keys) > 1)
    raise SceneError(f"--over {twice}: a key must be given once; found it twice. Remove one.")


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan
