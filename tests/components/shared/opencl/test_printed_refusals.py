"""Constructs that cannot be printed are refused: file, line, construct and remedy."""

import math

import numpy as np
import pytest

from quintet.components.shared.opencl.program import Program
from quintet.components.shared.opencl.refusal import PrintError
from quintet.components.shared.opencl.types import LANES, type_of

TABLE = {"a": 1.0}
TINY = 1e-200


def outside(x):
    return x


def loops_forever(x):
    while x > 0.0:
        x -= 1.0
    return x


def stores_in_an_array(a, x):
    a[0] = x
    return x


def loops_over_a_tuple(r):
    s = 0.0
    for x in r:
        s += x
    return s


def loops_a_varying_number_of_times(x):
    s = 0.0
    for _ in range(int(x)):
        s += x
    return s


def reads_a_varying_item(r):
    s = 0.0
    for d in range(3):
        s += r[d]
    return s


def reads_beyond_the_end(r):
    return r[3]


def raises(x):
    raise ValueError(x)


def returns_nothing(x):
    if x > 0.0:
        return x


def returns_two_types(x):
    if x > 0.0:
        return x
    return x, x


def reads_a_table(x):
    return TABLE["a"] * x


def makes_a_list(x):
    return [x, x][0]


def prints(x):
    print(x)
    return x


def calls_a_method(x):
    return x.conjugate()


def calls_by_keyword(x):
    return outside(x=x)


def calls_itself(x):
    return calls_itself(x - 1.0) if x > 0.0 else x


def has_a_default(x, y=1.0):
    return x * y


def has_any_arguments(*x):
    return 1.0


def takes_a_number_for_a_condition(x):
    return 1.0 if x else 0.0


def joins_numbers(x):
    return x or 1.0


def shifts_a_float(x):
    return x << 2


def raises_to_a_varying_power(x):
    return x ** int(x)


def inverts_a_whole_number(x):
    return int(x) ** -1


def unpacks_too_much(r):
    x, y = r
    return x + y


def changes_its_type(x):
    y = x
    y = x, x
    return y


def changes_an_argument(x):
    r = (x, x)
    x = r
    return x[0]


def compares_identity(x):
    return 1.0 if x is math.pi else 0.0


def compares_tuples(r):
    return 1.0 if r == r else 0.0


def uses_a_tiny_constant(x):
    return max(x, TINY)


def mixes_types(r, x):
    return r if x > 0.0 else x


def reads_no_field(x):
    return x.length


def reads_an_unknown_name(x):
    return x * unknown_number  # noqa: F821


def formats(x):
    return f"{x}"


def gives_too_few(x):
    return math.pow(x)


def adds_a_tuple(r, x):
    return r + x


def deletes(x):
    y = x
    del y
    return x


REFUSED = [
    (loops_forever, (0.0,), 2, "`while x > 0.0:`", "arrays, exceptions and other loops"),
    (stores_in_an_array, ((0.0,), 0.0), 2, "a value stored in `a[0]`", "store it in the kernel"),
    (loops_over_a_tuple, ((0.0,) * 3,), 3, "`for x in r`", "for name in range(number)"),
    (
        loops_a_varying_number_of_times,
        (0.0,),
        3,
        "`for _ in range(int(x))`",
        "known as the law is printed",
    ),
    (reads_a_varying_item, ((0.0,) * 3,), 4, "`r[d]`, an index that varies", "r[0], r[1] and r[2]"),
    (reads_beyond_the_end, ((0.0,) * 3,), 2, "`r[3]` of 3 items", "Correct it"),
    (raises, (0.0,), 2, "`raise ValueError(x)`", "exceptions"),
    (returns_nothing, (0.0,), 2, "a way to its end without a value", "Return a value at the end"),
    (returns_two_types, (0.0,), 4, "returns another type elsewhere", "the same number of numbers"),
    (reads_a_table, (0.0,), 2, "a constant {'a': 1.0}, no number", "as arguments"),
    (makes_a_list, (0.0,), 2, "`[x, x]`", "Pass what it needs"),
    (prints, (0.0,), 2, "`print(x)`", "Assign to locals"),
    (calls_a_method, (0.0,), 2, "a call of `x.conjugate`", "Pass what it needs"),
    (calls_by_keyword, (0.0,), 2, "`outside(x=x)`", "Pass arguments by position"),
    (calls_itself, (0.0,), 1, "calls_itself, which calls itself", "Write a loop"),
    (has_a_default, (0.0,), 1, "1 arguments for `x, y=1.0`", "by position and without defaults"),
    (has_any_arguments, (0.0,), 1, "1 arguments for `*x`", "one value for each parameter"),
    (takes_a_number_for_a_condition, (0.0,), 2, "`x` as a condition", "as x > 0"),
    (joins_numbers, (0.0,), 2, "`x` as a condition", "Write the comparison out"),
    (shifts_a_float, (0.0,), 2, "`x << 2`", "Shift and mask whole numbers alone"),
    (raises_to_a_varying_power, (0.0,), 2, "a whole exponent that varies", "Make the exponent a"),
    (inverts_a_whole_number, (0.0,), 2, "a whole number to a negative power", "a float"),
    (unpacks_too_much, ((0.0,) * 3,), 2, "3 values for 2 names", "Name each of them"),
    (changes_its_type, (0.0,), 3, "y, which changes its type", "its own name"),
    (changes_an_argument, (0.0,), 3, "x, which changes its type", "its own name"),
    (compares_identity, (0.0,), 2, "`x is math.pi`", "Compare with == or with None"),
    (compares_tuples, ((0.0,) * 3,), 2, "`r == r`", "Compare numbers"),
    (mixes_types, ((0.0,), 0.0), 2, "of two types", "Make them the same"),
    (reads_no_field, (0.0,), 2, "`x.length`, no field", "Pass what it needs"),
    (reads_an_unknown_name, (0.0,), 2, "the unknown name unknown_number", "Assign it before"),
    (formats, (0.0,), 2, "`f'{x}'`", "Pass what it needs"),
    (gives_too_few, (0.0,), 2, "`math.pow(x)`", "Give it 2 arguments"),
    (adds_a_tuple, ((0.0,), 0.0), 2, "`r`, no number", "Take a number of it"),
    (deletes, (0.0,), 3, "`del y`", "Assign to locals"),
]


NAMES = [case[0].__name__ for case in REFUSED]


@pytest.mark.parametrize(("law", "arguments", "line", "construct", "remedy"), REFUSED, ids=NAMES)
def test_a_construct_outside_the_subset_is_refused(law, arguments, line, construct, remedy):
    with pytest.raises(PrintError) as refusal:
        Program().add(law, *arguments)
    text = str(refusal.value)
    place = f"test_printed_refusals.py:{law.__code__.co_firstlineno + line - 1}, in {law.__name__}"
    assert text.startswith(place)
    assert construct in text and remedy in text and __file__ in text


def test_a_lambda_is_refused():
    law = lambda x: x  # noqa: E731
    with pytest.raises(PrintError, match=r"a lambda, or no function.*Define it with def"):
        Program().add(law, 0.0)


def test_an_array_is_refused():
    with pytest.raises(TypeError, match=r"found ndarray\. Read arrays in the kernel"):
        Program().add(outside, np.zeros(3))


def test_single_precision_refuses_constants_that_it_cannot_hold():
    with pytest.raises(PrintError, match=r"the constant 1e-200, which single precision cannot"):
        Program("single").add(uses_a_tiny_constant, 0.0)
    Program("double").add(uses_a_tiny_constant, 0.0)


def shortens(x):
    if x > 0.0:
        return 1.0
    return 0.0


def joins_truths(x):
    return 1.0 if x > 0.0 and x < 1.0 else 0.0


def rounds_down(x):
    return x // 2.0


def counts(x):
    return int(x)


def notices(x):
    return math.isnan(x)


@pytest.mark.parametrize("law", [shortens, joins_truths, rounds_down, counts, notices])
def test_what_lanes_cannot_do_together_is_refused(law):
    with pytest.raises(PrintError, match=r"of several lanes\. Print it for one lane, or use min"):
        Program("double", lanes=4).add(law, LANES)


def test_laws_without_branches_are_printed_for_several_lanes():
    program = Program("double", lanes=4)
    name, kind = program.add(bounded, LANES, 1.0)
    assert kind == LANES and "typedef double4 reals" in program.text
    assert f"static inline reals {name}(reals x, real most)" in program.text


def bounded(x, most):
    return max(min(x * 2.0, most), 0.0) ** 2 + math.sqrt(x)


def test_types_stand_for_themselves():
    assert type_of(type_of((1.0, None))) == type_of((2.0, None))
