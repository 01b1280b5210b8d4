"""The result of a kernel depends on its own options, not on its first caller."""

import math

from numba import njit

from quintet.components.shared.numba_options import EXACT, FAST, FAST_INNER, INNER, LANEWISE

ONCE = {"cache": False}


def _law_called_first_by_a_fast_loop():
    @njit(**EXACT | ONCE)
    def is_number(value):
        return value == value

    @njit(**FAST | ONCE)
    def loop(value):
        return is_number(value)

    loop(1.0)
    return is_number


def test_an_exact_law_notices_nan_though_a_fast_loop_compiled_it():
    is_number = _law_called_first_by_a_fast_loop()
    assert not is_number(math.nan)


def test_every_set_of_options_says_whether_arithmetic_is_fast():
    sets = (EXACT, FAST, INNER, FAST_INNER, LANEWISE)
    assert [options["fastmath"] for options in sets] == [False, True, False, True, False]
