"""TOML of scenes and settings, within limits: reading it takes a time that grows with its length.

A dotted key of thousands of parts, or a list of megabytes, is no scene: it would keep a check busy
for minutes, as TOML's reader looks at all tables above a key again for each of its parts.
"""

import re
import tomllib
from pathlib import Path
from typing import Any

from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import DEEPEST, shown

LARGEST_FILE = 1 << 20  # bytes of a scene; data belong into files beside it
MOST_TABLES = 1000  # of a kind: components, links, expectations
LONGEST_KEY = 200  # characters
PART = r"""(?:"[^"\n]*+"|'[^'\n]*+'|[\w-]++)[ \t]*+"""
DEEP = re.compile(rf"""(?<![\w"'-]){PART}(?:\.[ \t]*+{PART}){{{DEEPEST},}}""")
LONG = re.compile(rf"""^[ \t]*+\[*+[\w"'.-]{{{LONGEST_KEY * 8}}}""", re.MULTILINE)


def read_file(path: Path, subject: str = "a scene") -> dict[str, Any]:
    """Read a TOML file as it stands; messages have the subject of the file."""
    try:
        size = path.stat().st_size
        if size > LARGEST_FILE:
            raise SceneError(
                f"{path.name}: {subject} must have at most {LARGEST_FILE} bytes; found {size}. Put "
                "data into a file beside it."
            )
        return parsed(path.read_bytes().decode())
    except (OSError, ValueError) as error:
        raise SceneError(f"{path.name}: {subject} must be valid TOML: {error}.") from error
    except RecursionError as error:
        raise SceneError(
            f"{path.name}: {subject} must be valid TOML, its lists and tables at most {DEEPEST} "
            "deep; found more. Flatten them."
        ) from error


def parsed(text: str) -> dict[str, Any]:
    """Parse TOML whose keys are neither too deep nor too long to be read in good time."""
    if match := DEEP.search(text) or LONG.search(text):
        raise ValueError(
            f"keys must have at most {DEEPEST} parts of {LONGEST_KEY} characters; found "
            f"{shown(match[0])}"
        )
    return tomllib.loads(text)


def too_many(table: dict[str, Any]) -> list[str]:
    """Sentences about tables of a scene that are more than any run could have."""
    counts = {key: len(entry) for key, entry in table.items() if isinstance(entry, (dict, list))}
    return [
        f"{key} must be at most {MOST_TABLES}; found {count}. Leave some out."
        for key, count in counts.items()
        if count > MOST_TABLES
    ]


def value_of(text: str) -> Any:
    """Parse what is set on the command line: a value of TOML, all of it, or a word.

    Raises
    ------
    ValueError
        It is neither; of a part of it nothing is made.
    """
    if not text.strip():
        raise ValueError('there is no value; an empty text is written ""')
    if any(sign in text for sign in "\n\r\0"):
        raise ValueError("a value must be on one line")
    if len(text) > LARGEST_FILE:
        raise ValueError("it is too long; put data into a file beside the scene")
    try:
        # In a list, what follows the value is a mistake: a comment, a comma, another value.
        values = parsed(f"value = [{text}]")["value"]
        if len(values) == 1 and not text.rstrip().endswith(","):
            return values[0]
    except (ValueError, RecursionError):
        pass
    if text.lstrip()[0] in "[{\"'" or "#" in text or "," in text:
        raise ValueError("it must be one value of TOML, with nothing after it")
    return text  # a word needs no quotes on the command line
