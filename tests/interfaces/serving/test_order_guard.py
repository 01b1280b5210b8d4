"""Orders come in the one legal order; every other is refused, and says what would be legal."""

import itertools

import pytest

from quintet.interfaces.errors import OrderError
from quintet.interfaces.serving.order_guard import LEGAL, OrderGuard

ORDERS = sorted({order for orders in LEGAL.values() for order in orders} | {"go", "", "advance2"})
WAYS = {
    "new": [],
    "described": ["describe"],
    "ready": ["describe", "bind"],
    "finished": ["describe", "bind", "finish"],
}


def guard(state):
    made = OrderGuard("water")
    for order in WAYS[state]:
        made.allow(order)
    assert made.state == state
    return made


@pytest.mark.parametrize(("state", "order"), list(itertools.product(LEGAL, ORDERS)))
def test_every_order_in_every_state_is_allowed_or_refused(state, order):
    made = guard(state)
    if order == "rewind" and order in LEGAL[state]:
        made.allow("keep")
    if order in LEGAL[state]:
        made.allow(order)
        assert made.state == LEGAL[state][order]
        return
    with pytest.raises(OrderError) as error:
        made.allow(order)
    legal = ", ".join(LEGAL[state]) or "none"
    assert str(error.value) == (
        f"water: when {state}, an order must be one of {legal}; found {order!r}."
    )
    assert made.state == state


@pytest.mark.parametrize("window", [-1, 0, 2, 7])
def test_windows_come_in_order(window):
    made = guard("ready")
    made.allow("advance", 0)
    with pytest.raises(OrderError, match=f"window 1 is next; window {window} was ordered"):
        made.allow("advance", window)
    made.allow("advance", 1)


def test_rewind_needs_a_kept_state_and_comes_back_to_its_window():
    made = guard("ready")
    with pytest.raises(OrderError, match="rewind needs a kept state; order keep first"):
        made.allow("rewind")
    made.allow("advance", 0)
    made.allow("keep", 1)
    for _ in range(3):
        made.allow("advance", 1)
        made.allow("rewind", 1)
    made.allow("advance", 1)
    with pytest.raises(OrderError, match="window 2 is next"):
        made.allow("advance", 1)


def test_a_loaded_state_brings_its_window():
    made = guard("ready")
    made.allow("load", 40)
    with pytest.raises(OrderError, match="window 40 is next"):
        made.allow("advance", 0)
    made.allow("advance", 40)
