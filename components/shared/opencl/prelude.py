"""First lines of each printed program: precision, and operations that match numba's."""

from typing import Literal

Precision = Literal["double", "single"]

REALS = {
    "double": "#pragma OPENCL EXTENSION cl_khr_fp64 : enable\ntypedef double real;\n"
    "typedef double4 real4;\n#define as_real as_double\n#define as_whole as_long\n",
    "single": "typedef float real;\ntypedef float4 real4;\n"
    "#define as_real as_float\n#define as_whole as_int\n",
}
OPERATIONS = """
/* As numba has them: the second of two numbers only if it is greater, or less. */
static real max_real(real a, real b) { return b > a ? b : a; }
static real min_real(real a, real b) { return b < a ? b : a; }
static long max_long(long a, long b) { return b > a ? b : a; }
static long min_long(long a, long b) { return b < a ? b : a; }
static long abs_long(long a) { return a < 0 ? -a : a; }

/* Of 64 bits that wrap around: see shared/wrapped_integers.py. */
static long wrapped_sum(long a, long b) { return (long)((ulong)a + (ulong)b); }
static long wrapped_product(long a, long b) { return (long)((ulong)a * (ulong)b); }
static long shifted_down(long a, long b) { return (long)((ulong)a >> b); }

/* Quotients and remainders of Python: rounded down; 0 over 0, as numpy has it. */
static long floor_divide_long(long a, long b) {
    if (b == 0) return 0;
    const long whole = a / b;
    return a % b != 0 && (a % b < 0) != (b < 0) ? whole - 1 : whole;
}
static long modulo_long(long a, long b) {
    if (b == 0) return 0;
    const long rest = a % b;
    return rest != 0 && (rest < 0) != (b < 0) ? rest + b : rest;
}
static real modulo_real(real a, real b) {
    const real rest = fmod(a, b);
    if (rest == 0) return copysign((real)0, b);
    return (rest < 0) != (b < 0) ? rest + b : rest;
}
static real floor_divide_real(real a, real b) {
    if (b == 0) return a / b;
    const real rest = fmod(a, b);
    real quotient = (a - rest) / b;
    if (rest != 0 && (rest < 0) != (b < 0)) quotient -= 1;
    if (quotient == 0) return copysign((real)0, a / b);
    const real whole = floor(quotient);
    return quotient - whole > (real)0.5 ? whole + 1 : whole;
}
"""


IN_LANES = """
static reals max_reals(reals a, reals b) { return b > a ? b : a; }
static reals min_reals(reals a, reals b) { return b < a ? b : a; }
"""


def prelude(precision: Precision, lanes: int) -> str:
    """First lines of a program; products are never contracted with sums."""
    of_lanes = f"typedef {precision_name(precision)}{lanes if lanes > 1 else ''} reals;\n"
    whole = {"double": "long", "single": "int"}[precision]
    of_lanes += f"typedef {f'{whole}{lanes}' if lanes > 1 else 'int'} mask;\n"
    exact = "#pragma OPENCL FP_CONTRACT OFF\n"
    return f"{REALS[precision]}{of_lanes}{exact}{OPERATIONS}{IN_LANES}"


def precision_name(precision: Precision) -> str:
    """Type of a number in C."""
    return {"double": "double", "single": "float"}[precision]


def power_function(kind: str, exponent: int) -> str:
    """Function that raises to a whole power by squaring, multiplying in numba's order."""
    unit = "1L" if kind == "long" else f"({kind})1"
    lines, rest = [], abs(exponent)
    while rest:
        if rest & 1:
            lines.append("result *= square;")
        rest >>= 1
        if rest:
            lines.append("square *= square;")
    end = "1 / result" if exponent < 0 else "result"
    body = "\n    ".join([f"{kind} square = x, result = {unit};", *lines, f"return {end};"])
    return f"static {kind} {power_name(kind, exponent)}({kind} x) {{\n    {body}\n}}"


def power_name(kind: str, exponent: int) -> str:
    """Name of the function that `power_function` prints."""
    return f"power_{kind}_{'minus_' if exponent < 0 else ''}{abs(exponent)}"
