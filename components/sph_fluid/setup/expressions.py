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


def _checked(expression: float | str) -> float | str:
    """Refuse what is no expression, before anything is computed."""
    if isinstance(expression, str):
        _check(_parse(expression), expression, 0)
    elif not math.isfinite(expression):
        raise ValueError(f"a number must be finite; found {expression}. Correct it.")
    return expression


Expression = Annotated[float | str, AfterValidator(_checked)]


def values_at(expression: float | str, points: Array, name: str) -> Array:
    """Values (n,) of an expression at points (n, 3) m; all must be finite."""
    if not isinstance(expression, str):
        return np.full(len(points), float(expression))
    places = dict(zip(COORDINATES, points.T, strict=True))
    with np.errstate(all="ignore"):
        values = _value(_parse(expression), places)
        values = np.array(np.broadcast_to(values, len(points)), np.float64)
    infinite = np.flatnonzero(~np.isfinite(values))
    if len(infinite):
        x, y, z = points[infinite[0]].tolist()
        raise ValueError(
            f"{name} must be finite in all of the fluid; {expression!r} is {values[infinite[0]]} "
            f"at ({x:.4g}, {y:.4g}, {z:.4g}) m. Correct it."
        )
    return values


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
    for operand in inner:
        _check(operand, text, depth + 1)


def _inner(node: ast.expr) -> list[ast.expr] | None:
    """Operands of a node; None if the node is not known."""
    match node:
        case ast.Constant(value=int() | float() as value) if not isinstance(value, bool):
            return []
        case ast.Name(id=name) if name in (*COORDINATES, *CONSTANTS):
            return []
        case ast.UnaryOp(op=op, operand=left) if type(op) in OPERATORS:
            return [left]
        case ast.BinOp(left=left, op=op, right=right) if type(op) in OPERATORS:
            return [left, right]
        case ast.Compare(left=left, ops=[op], comparators=[right]) if type(op) in OPERATORS:
            return [left, right]
        case ast.Call(func=ast.Name(id=name), args=arguments, keywords=[]) if name in FUNCTIONS:
            return arguments if len(arguments) == FUNCTIONS[name][1] else None
    return None


def _value(node: ast.expr, places: Mapping[str, Array]) -> Any:
    """Value of a node that was checked."""
    match node:
        case ast.Constant(value=value):
            return np.float64(_number(value))
        case ast.Name(id=name):
            return places[name] if name in places else np.float64(CONSTANTS[name])
        case ast.UnaryOp(op=op, operand=left):
            return OPERATORS[type(op)](_value(left, places))
        case ast.BinOp(left=left, op=op, right=right):
            return OPERATORS[type(op)](_value(left, places), _value(right, places))
        case ast.Compare(left=left, ops=[op], comparators=[right]):
            flags = OPERATORS[type(op)](_value(left, places), _value(right, places))
            return np.asarray(flags, np.float64)
        case ast.Call(func=ast.Name(id=name), args=arguments):
            return FUNCTIONS[name][0](*(_value(left, places) for left in arguments))
    raise ValueError(f"an expression must be one of {KNOWN}.")


def _number(value: Any) -> float:
    try:
        return float(value)
    except OverflowError:
        return math.inf
