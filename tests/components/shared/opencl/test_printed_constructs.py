"""Each construct that a printed law may use has the bits of numba."""

import math
from typing import NamedTuple

import numpy as np
import pytest
from numba import njit

from quintet.components.shared.opencl.program import Program
from quintet.components.shared.opencl.types import LANES, REAL, bytes_of, memory_type, type_of
from quintet.components.shared.smoothing import cubic_spline

pytest.importorskip("pyopencl")
from printed_laws import ROWS, Between, Law, draw, run_by_numba, run_on_device, ulps, vector

from quintet.components.shared.opencl.arrays import DeviceArray
from quintet.components.shared.opencl.devices import build, device_of

HALF = 0.5
WHOLE = np.int8(3)
ANY = Between(-5.0, 5.0)


class Inner(NamedTuple):
    on: bool | None
    scale: float


class Outer(NamedTuple):
    inner: Inner
    count: int


def arithmetic(a, b):
    return (a + b) * (a - b) - a / b + (-a) + (+b) - HALF * WHOLE


def powers(a):
    return a**2, a**3, a**-2, a**7, a**0


def whole_numbers(a, b):
    i, j = int(a), int(b)
    return i + j, i * j - 3, i // j, i % j, i / j, i**3, abs(i), min(i, j), max(i, j, 2)


def rounded_quotients(a, b):
    return a // b, a % b, a // 0.5, -7.0 % b


def bits_of_whole_numbers(a, b):
    i, j = int(a * 100.0), int(abs(b))
    return (i << j) ^ (i & 255) | (j << 3), i >> 2


def extremes(a, b):
    return min(a, b), max(a, b), max(a, 0), min(a, b, 1.0), max(a, math.nan), abs(a), math.fabs(b)


def scalar_functions(a):
    b = abs(a) + 0.1
    return (
        math.sqrt(b), np.sqrt(b), math.floor(a), np.floor(a), math.ceil(a), np.ceil(a),
        math.trunc(a), math.copysign(b, a), math.isnan(a),
        math.isfinite(b), float(3),
    )  # fmt: skip


def branches(a, b):
    if a > b and not b > 1.0:
        c = 1
    elif a == b or b != b:
        c = 2.0
    else:
        c = a
    if 0.0 <= a < b:
        return c
    return -c


def conditional(a, b):
    return a if a > b else 0, 1.0 if -1.0 < a < 1.0 < b else b


def swapped(a, b):
    a, b = b, a
    (c, d), e = (a - b, b), a
    c += d
    c *= 2
    x: float = c
    return x, a, e


def loops(a):
    s = 0.0
    for i in range(4):
        s = s * a + i
        if s > 50.0:
            return s
    for _ in range(6, 0, -2):
        s -= 1.0
    return s


def ends_early(a):
    s = 0.0
    for i in range(9):
        s = s * a + i
        if s > 5.0:
            break
        s += 1.0
    return s


@njit(error_model="numpy")
def last(r):
    """Return the last of three numbers, and the count."""
    x, _, z = r
    return r[-1] * x + z + r[1], len(r)


def turned(r, angle):
    return last((r[1], r[2], r[0])), cubic_spline.shape(angle)


@njit(error_model="numpy")
def remade(outer):
    inner = Inner(None, outer.inner.scale * 2.0)
    return Outer(inner, outer.count + 1)


def reads_records(outer, a):
    if outer.inner.on is not None:
        a *= outer.inner.scale
    if outer.inner.on is None:
        return a - remade(outer).inner.scale
    return a + outer.count + (0.0 if outer.inner.on is None else 1.0)


def flags(a, on):
    is_large = a > 1.0
    return 2.0 if is_large and on else 3.0, is_large


def truths_together(a, b):
    return ((a > 0.0) & (b > 0.0)), ((a > 0.0) | (b > 0.0)), ((a > 0.0) ^ (b > 0.0))


def chosen(a, b):
    """Of lanes too: nothing branches."""
    is_near = (a > -1.0) & (-2.0 < b <= 2.0)
    return a * b if is_near else (a if a > b else -1.0)


def unicode_names(ρ, μ_r, half, kernel):
    """Names in other alphabets, and names reserved in C."""
    double = ρ * μ_r
    return double + half - kernel


LAWS = [
    Law(arithmetic, (ANY, ANY)),
    Law(powers, (ANY,)),
    Law(whole_numbers, (Between(-9.0, 9.0), Between(1.0, 9.0))),
    Law(whole_numbers, (Between(-9.0, 9.0), Between(-9.0, -1.0)), name=" of negative numbers"),
    Law(whole_numbers, (7.0, 0.0), name=" over 0"),
    Law(rounded_quotients, (ANY, Between(-2.0, 2.0))),
    Law(rounded_quotients, (4.5, Between(-1.5, -1.5)), name=" without rest"),
    Law(bits_of_whole_numbers, (ANY, ANY)),
    Law(extremes, (ANY, ANY)),
    Law(extremes, (math.nan, 1.0), name=" of what is no number"),
    Law(scalar_functions, (ANY,)),
    Law(branches, (Between(-2.0, 2.0), Between(-2.0, 2.0))),
    Law(branches, (1.5, 1.5), name=" of equal numbers"),
    Law(conditional, (ANY, ANY)),
    Law(swapped, (ANY, ANY)),
    Law(loops, (ANY,)),
    Law(ends_early, (ANY,)),
    Law(last, (vector(1.0),)),
    Law(turned, (vector(1.0), Between(0.0, 2.0))),
    Law(reads_records, (Outer(Inner(True, ANY), 3), ANY), name=" that are on"),
    Law(reads_records, (Outer(Inner(None, ANY), 3), ANY), name=" that are off"),
    Law(flags, (ANY, True)),
    Law(truths_together, (ANY, ANY)),
    Law(chosen, (ANY, ANY)),
    Law(unicode_names, (ANY, ANY, ANY, ANY)),
]


@pytest.fixture(scope="module")
def results():
    random = np.random.default_rng(7)
    rows = [
        [tuple(draw(argument, random) for argument in law.arguments) for _ in range(ROWS)]
        for law in LAWS
    ]
    with np.errstate(all="ignore"):
        numba = [run_by_numba(law, law_rows) for law, law_rows in zip(LAWS, rows, strict=True)]
    return {
        law.name: pair
        for law, pair in zip(LAWS, zip(numba, run_on_device(LAWS, rows), strict=True), strict=True)
    }


@pytest.mark.parametrize("name", [law.name for law in LAWS])
def test_printed_constructs_have_the_bits_of_numba(results, name):
    of_processor, printed = results[name]
    assert of_processor.shape == printed.shape
    assert ulps(of_processor, printed) == 0.0
    zeros = (of_processor == 0.0) & (printed == 0.0)
    assert np.array_equal(np.signbit(of_processor[zeros]), np.signbit(printed[zeros]))


def test_single_precision_is_single_throughout():
    program = Program("single")
    program.add(arithmetic, 0.0, 0.0)
    program.add(powers, 0.0)
    text = program.text
    assert "typedef float real" in text and "0.5f" in text and "double" not in text


def test_single_precision_agrees_to_its_rounding():
    random = np.random.default_rng(7)
    law = LAWS[0]
    rows = [tuple(draw(argument, random) for argument in law.arguments) for _ in range(ROWS)]
    (single,) = run_on_device([law], [rows], "single")
    (double,) = run_on_device([law], [rows])
    assert single.dtype == np.float32
    scale = 5.0 * 5.0 + np.abs([a / b for a, b in rows]).reshape(-1, 1)
    assert (np.abs(single - double) < 4e-7 * 4.0 * scale).all()


def test_products_are_never_contracted_with_sums():
    assert "#pragma OPENCL FP_CONTRACT OFF" in Program().text


def test_a_law_is_printed_once_for_a_set_of_types():
    program = Program()
    name, _ = program.add(reads_records, Outer(Inner(True, 1.0), 3), 0.0)
    repeated_name, _ = program.add(reads_records, Outer(Inner(False, 2.0), 5), 1.0)
    other_name, _ = program.add(reads_records, Outer(Inner(None, 1.0), 3), 0.0)
    assert name == repeated_name != other_name
    assert program.text.count(f" {name}(") == 1


def test_structs_lie_in_memory_as_the_device_has_them():
    value = Outer(Inner(True, 2.5), 3)
    memory = bytes_of(value, np.float64)
    assert memory.dtype.itemsize == 24
    assert float(memory["inner"]["scale"]) == 2.5 and int(memory["count"]) == 3
    off = memory_type(type_of(Outer(Inner(None, 2.5), 3)), np.float32)
    assert off.fields["inner"][0].names == ("scale",) and off.itemsize == 16
    assert memory_type(REAL, np.float32) == np.float32


LANEWISE = """
__kernel void choose(__global const reals *a, __global const reals *b, __global reals *result)
{
    const int i = get_global_id(0);
    result[i] = NAME(a[i], b[i]);
}
"""


@pytest.mark.parametrize("lanes", [1, 4])
def test_lanes_choose_each_for_itself(lanes):
    program = Program("double", lanes)
    name, kind = program.add(chosen, LANES, LANES)
    assert kind == LANES
    queue = device_of("opencl").queue()
    kernel = build(queue, program.text + LANEWISE.replace("NAME", name)).choose
    a, b = np.random.default_rng(3).uniform(-5.0, 5.0, (2, 64))
    result = DeviceArray(queue, a.shape)
    kernel(
        queue, (len(a) // lanes,), None,
        *(array.memory for array in (DeviceArray.of(queue, a), DeviceArray.of(queue, b), result)),
    )  # fmt: skip
    expected = [chosen(*pair) for pair in zip(a, b, strict=True)]
    assert np.array_equal(result.get(), expected)
