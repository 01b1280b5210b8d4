"""Calls of functions that OpenCL has, in OpenCL C."""

import ast
from typing import Any

from quintet.components.shared.opencl.functions import BITS, EXTREMES, SCALAR, TO_INT, TO_REAL
from quintet.components.shared.opencl.prelude import Precision
from quintet.components.shared.opencl.refusal import Place
from quintet.components.shared.opencl.types import INT, LANES, NUMBERS, REAL, Type
from quintet.components.shared.opencl.values import Value, converted

ONE_LANE = "Print it for one lane, or use min, max and conditional expressions of numbers, and &."
PASS_NUMBERS = "Pass what it needs as arguments, or write it out."


def c_name(kind: Type) -> str:
    """Type of numbers that the operations of the prelude have for a type."""
    return kind.name if kind in (REAL, LANES) else "long"


def intrinsic(
    place: Place, precision: Precision, function: Any, arguments: list[Value], node: ast.Call
) -> Value | None:
    """Print a call of a function that OpenCL has; None for others."""
    kinds = [argument.kind for argument in arguments]
    is_known = function in EXTREMES or function in TO_REAL or function in TO_INT
    if not (is_known or function is abs or function in SCALAR):
        return None
    if any(kind not in NUMBERS for kind in kinds):
        raise place.refuse(node, f"`{ast.unparse(node)}`, not of numbers", PASS_NUMBERS)
    in_lanes = LANES in kinds
    if in_lanes and (function in TO_REAL or function in TO_INT or function in BITS):
        raise place.refuse(node, f"`{ast.unparse(node)}` of several lanes", ONE_LANE)
    if function in TO_REAL:
        return converted(arguments[0], REAL, precision)
    if function in TO_INT:
        return Value(f"(long)({arguments[0].code})", INT)
    if function in EXTREMES:
        kind = max(*kinds, INT, key=NUMBERS.index)
        result = converted(arguments[0], kind, precision).code
        for argument in arguments[1:]:
            operand = converted(argument, kind, precision).code
            result = f"{EXTREMES[function]}_{c_name(kind)}({result}, {operand})"
        return Value(result, kind)
    if function is abs and kinds == [INT]:
        return Value(f"abs_long({arguments[0].code})", INT)
    name, argument_kinds, result_kind = (
        ("fabs", (REAL,), REAL) if function is abs else SCALAR[function]
    )
    if function in BITS and precision == "single":
        raise place.refuse(
            node, f"`{ast.unparse(node)}` in single precision", "Print it in double precision."
        )
    if len(argument_kinds) != len(arguments):
        raise place.refuse(
            node, f"`{ast.unparse(node)}`", f"Give it {len(argument_kinds)} arguments."
        )
    if in_lanes:
        if result_kind != REAL:
            raise place.refuse(node, f"`{ast.unparse(node)}` of several lanes", ONE_LANE)
        argument_kinds, result_kind = (LANES,) * len(argument_kinds), LANES
    pairs = zip(arguments, argument_kinds, strict=True)
    codes = ", ".join(converted(argument, kind, precision).code for argument, kind in pairs)
    return Value(f"{name}({codes})", result_kind)
