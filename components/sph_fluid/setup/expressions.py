"""Expressions of x, y and z, such as "0.1 * sin(2 * pi * x)".

They are read into a syntax tree, and only nodes that are listed here are computed: numbers, the
three coordinates, operators, functions and comparisons. Nothing is run as a program.
"""

import ast
import math
import warnings
from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator

Array = NDArray[np.float64]

LONGEST = 1000  # characters
DEEPEST = 40  # nodes inside each other
CONSTANTS = {"pi": math.pi}
COORDINATES = ("x", "y", "z")
FUNCTIONS: dict[str, tuple[Any, int]] = {  # and how many arguments they take
    "sin": (np.sin, 1),
    "cos": (np.cos, 1),
    "tan": (np.tan, 1),
    "sinh": (np.sinh, 1),
    "cosh": (np.cosh, 1),
    "tanh": (np.tanh, 1),
    "exp": (np.exp, 1),
    "log": (np.log, 1),
    "sqrt": (np.sqrt, 1),
    "abs": (np.abs, 1),
    "atan2": (np.arctan2, 2),
    "hypot": (np.hypot, 2),
    "min": (np.minimum, 2),
    "max": (np.maximum, 2),
    "where": (np.where, 3),
}
OPERATORS: dict[type, Any] = {
    ast.Add: np.add,
    ast.Sub: np.subtract,
    ast.Mult: np.multiply,
    ast.Div: np.divide,
    ast.Pow: np.power,
    ast.UAdd: np.positive,
    ast.USub: np.negative,
    ast.Lt: np.less,
    ast.LtE: np.less_equal,
    ast.Gt: np.greater,
    ast.GtE: np.greater_equal,
}
KNOWN = (
    f"numbers, {', '.join(COORDINATES)}, {', '.join(CONSTANTS)}, + - * / **, < <= > >= and "
    f"{', '.join(FUNCTIONS)}"
)


def _checked(given: float | str) -> float | str:
    """Refuse what is no expression, before anything is computed."""
    if isinstance(given, str):
        _check(_parse(given), given, 0)
    elif not math.isfinite(given):
        raise ValueError(f"a number must be finite; found {given}. Correct it.")
    return given


Expression = Annotated[float | str, AfterValidator(_checked)]


def values_at(given: float | str, points: Array, what: str) -> Array:
    """Values (n,) of an expression at points (n, 3) m; all must be finite."""
    if not isinstance(given, str):
        return np.full(len(points), float(given))
    places = dict(zip(COORDINATES, points.T, strict=True))
    with np.errstate(all="ignore"):
        found = _value(_parse(given), places)
        found = np.array(np.broadcast_to(found, len(points)), np.float64)
    bad = np.flatnonzero(~np.isfinite(found))
    if len(bad):
        x, y, z = points[bad[0]].tolist()
        raise ValueError(
            f"{what} must be finite in all of the fluid; {given!r} is {found[bad[0]]} at ({x:.4g}, "
            f"{y:.4g}, {z:.4g}) m. Correct it."
        )
    return found


def _parse(text: str) -> ast.expr:
    if len(text) > LONGEST:
        raise ValueError(
            f"an expression must have at most {LONGEST} characters; found {len(text)}. Use a table."
        )
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return ast.parse(text.strip(), mode="eval").body
    except (SyntaxError, ValueError, MemoryError, RecursionError) as error:
        raise ValueError(
            f"an expression must be one of {KNOWN}; {text[:60]!r} cannot be read ({error}). "
            "Correct it."
        ) from error


def _check(node: ast.expr, text: str, depth: int) -> None:
    """Refuse nodes that are not known."""
    if depth > DEEPEST:
        raise ValueError(
            f"an expression must be at most {DEEPEST} deep; {text[:60]!r} is deeper. Use a table."
        )
    inner = _inner(node)
    if inner is None:
        raise ValueError(
            f"an expression must be one of {KNOWN}; found {ast.unparse(node)[:60]!r}. Correct it."
        )
    for one in inner:
        _check(one, text, depth + 1)


def _inner(node: ast.expr) -> list[ast.expr] | None:
    """What a node is computed from; None if it is not known."""
    match node:
        case ast.Constant(value=int() | float() as value) if not isinstance(value, bool):
            return []
        case ast.Name(id=name) if name in (*COORDINATES, *CONSTANTS):
            return []
        case ast.UnaryOp(op=op, operand=one) if type(op) in OPERATORS:
            return [one]
        case ast.BinOp(left=one, op=op, right=other) if type(op) in OPERATORS:
            return [one, other]
        case ast.Compare(left=one, ops=[op], comparators=[other]) if type(op) in OPERATORS:
            return [one, other]
        case ast.Call(func=ast.Name(id=name), args=given, keywords=[]) if name in FUNCTIONS:
            return given if len(given) == FUNCTIONS[name][1] else None
    return None


def _value(node: ast.expr, places: Mapping[str, Array]) -> Any:
    """Value of a node that was checked."""
    match node:
        case ast.Constant(value=value):
            return np.float64(_number(value))
        case ast.Name(id=name):
            return places[name] if name in places else np.float64(CONSTANTS[name])
        case ast.UnaryOp(op=op, operand=one):
            return OPERATORS[type(op)](_value(one, places))
        case ast.BinOp(left=one, op=op, right=other):
            return OPERATORS[type(op)](_value(one, places), _value(other, places))
        case ast.Compare(left=one, ops=[op], comparators=[other]):
            found = OPERATORS[type(op)](_value(one, places), _value(other, places))
            return np.asarray(found, np.float64)
        case ast.Call(func=ast.Name(id=name), args=given):
            return FUNCTIONS[name][0](*(_value(one, places) for one in given))
    raise ValueError(f"an expression must be one of {KNOWN}.")


def _number(value: Any) -> float:
    try:
        return float(value)
    except OverflowError:
        return math.inf
