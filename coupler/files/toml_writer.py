"""TOML writer; the standard library only reads TOML."""

import json
import re
from typing import Any

BARE = re.compile(r"[A-Za-z0-9_-]+")


def dumps(table: dict[str, Any]) -> str:
    """Write a table as TOML; reading it gives an equal table."""
    return "\n".join(_table(table, ())) + "\n"


def _table(table: dict[str, Any], path: tuple[str, ...]) -> list[str]:
    plain = {k: v for k, v in table.items() if not _nested(v)}
    lines = [f"[{'.'.join(map(_key, path))}]"] if path and (plain or not table) else []
    lines += [f"{_key(key)} = {value_text(value)}" for key, value in plain.items()]
    for key, value in table.items():
        if isinstance(value, dict):
            lines += ["", *_table(value, (*path, key))]
        elif _nested(value):
            for one in value:
                head = f"[[{'.'.join(map(_key, (*path, key)))}]]"
                lines += ["", head, *(f"{_key(k)} = {value_text(v)}" for k, v in one.items())]
    return lines


def _nested(value: Any) -> bool:
    if isinstance(value, list):
        return bool(value) and all(isinstance(one, dict) for one in value)
    return isinstance(value, dict)


def _key(key: str) -> str:
    return key if BARE.fullmatch(key) else json.dumps(key)


def value_text(value: Any) -> str:
    """Write one value as TOML."""
    if hasattr(value, "tolist"):
        value = value.tolist()  # numpy's numbers and arrays
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_key(k)} = {value_text(v)}" for k, v in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(value_text(one) for one in value) + "]"
    return json.dumps(str(value), ensure_ascii=False)
