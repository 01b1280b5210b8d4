"""Truth values in OpenCL C: of one number, or of each of several lanes."""

import ast
from collections.abc import Sequence

from quintet.components.shared.opencl.functions import BITWISE, COMPARED
from quintet.components.shared.opencl.prelude import Precision
from quintet.components.shared.opencl.types import FLAG, LANES, MASK, NUMBERS
from quintet.components.shared.opencl.values import Value, converted


def compared(
    operators: Sequence[ast.cmpop], operands: Sequence[Value], precision: Precision
) -> Value | None:
    """Print a chain of comparisons; None if its operands cannot be compared."""
    if any(operand.kind not in NUMBERS for operand in operands):
        return None
    parts, kinds = [], set()
    for op, *pair in zip(operators, operands[:-1], operands[1:], strict=True):
        if type(op) not in COMPARED:
            return None
        kind = max(pair[0].kind, pair[1].kind, key=NUMBERS.index)
        a, b = (converted(operand, kind, precision).code for operand in pair)
        parts.append(f"({a} {COMPARED[type(op)]} {b})")
        kinds.add(MASK if kind == LANES else FLAG)
    if len(kinds) > 1:
        return None
    (kind,) = kinds
    together = f" {'&' if kind == MASK else '&&'} "
    return Value(parts[0] if len(parts) == 1 else f"({together.join(parts)})", kind)


def combined(op: ast.operator, left: Value, right: Value) -> Value | None:
    """Print `&`, `|` or `^` of two truth values; None of numbers."""
    is_truth = left.kind == right.kind and left.kind in (FLAG, MASK)
    if not is_truth or not isinstance(op, ast.BitAnd | ast.BitOr | ast.BitXor):
        return None
    return Value(f"({left.code} {BITWISE[type(op)]} {right.code})", left.kind)
