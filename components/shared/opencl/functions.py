"""Functions of Python, numpy and mathematics that are printed by their names in OpenCL C."""

import ast
import math
from typing import Any

import numpy as np

from quintet.components.shared.float_bits import bits_of, number_of
from quintet.components.shared.opencl.types import FLAG, INT, REAL, Type
from quintet.components.shared.wrapped_integers import shifted_down, wrapped_product, wrapped_sum

_ONE = "sqrt exp log log10 log1p expm1 sin cos tan sinh cosh tanh cbrt".split()
_OF_NUMPY = {"asin": "arcsin", "acos": "arccos", "atan": "arctan"}

# Function of Python: name in C, types of arguments, type of its value.
SCALAR: dict[Any, tuple[str, tuple[Type, ...], Type]] = {
    math.pow: ("pow", (REAL, REAL), REAL),
    math.floor: ("(long)floor", (REAL,), INT),
    math.ceil: ("(long)ceil", (REAL,), INT),
    math.trunc: ("(long)trunc", (REAL,), INT),
    math.isnan: ("isnan", (REAL,), FLAG),
    math.isinf: ("isinf", (REAL,), FLAG),
    math.isfinite: ("isfinite", (REAL,), FLAG),
    math.erf: ("erf", (REAL,), REAL),
    np.power: ("pow", (REAL, REAL), REAL),
    np.floor: ("floor", (REAL,), REAL),
    np.ceil: ("ceil", (REAL,), REAL),
    np.rint: ("rint", (REAL,), REAL),
    np.isnan: ("isnan", (REAL,), FLAG),
    np.isfinite: ("isfinite", (REAL,), FLAG),
    bits_of: ("as_whole", (REAL,), INT),
    number_of: ("as_real", (INT,), REAL),
    wrapped_sum: ("wrapped_sum", (INT, INT), INT),
    wrapped_product: ("wrapped_product", (INT, INT), INT),
    shifted_down: ("shifted_down", (INT, INT), INT),
}
for _name in _ONE:
    SCALAR[getattr(math, _name)] = SCALAR[getattr(np, _name)] = (_name, (REAL,), REAL)
for _name in ("asin", "acos", "atan"):
    SCALAR[getattr(math, _name)] = SCALAR[getattr(np, _OF_NUMPY[_name])] = (_name, (REAL,), REAL)
SCALAR |= dict.fromkeys((math.fabs, np.abs, np.fabs), ("fabs", (REAL,), REAL))
SCALAR |= dict.fromkeys((math.hypot, np.hypot), ("hypot", (REAL, REAL), REAL))
SCALAR |= dict.fromkeys((math.atan2, np.arctan2), ("atan2", (REAL, REAL), REAL))
SCALAR |= dict.fromkeys((math.copysign, np.copysign), ("copysign", (REAL, REAL), REAL))

BITS = frozenset({bits_of, number_of})  # in double precision alone: they know where digits are
TO_REAL = frozenset({float, np.float64})
TO_INT = frozenset({int, np.int64})
EXTREMES = {min: "min", max: "max"}
ARITHMETIC: dict[type[ast.operator], str] = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*"}
BITWISE: dict[type[ast.operator], str] = {
    ast.LShift: "<<", ast.RShift: ">>", ast.BitAnd: "&", ast.BitOr: "|", ast.BitXor: "^",
}  # fmt: skip
ROUNDED_DOWN: dict[type[ast.operator], str] = {ast.FloorDiv: "floor_divide", ast.Mod: "modulo"}
COMPARED: dict[type[ast.cmpop], str] = {
    ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!=",
}  # fmt: skip
