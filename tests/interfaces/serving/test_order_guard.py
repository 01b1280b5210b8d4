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
    order_guard = OrderGuard("water")
    for order in WAYS[state]:
        order_guard.allow(order)
    assert order_guard.state == state
    return order_guard


@pytest.mark.parametrize(("state", "order"), list(itertools.product(LEGAL, ORDERS)))
def test_every_order_in_every_state_is_allowed_or_refused(state, order):
    order_guard = guard(state)
    if order == "rewind" and order in LEGAL[state]:
        order_guard.allow("keep")
    if order in LEGAL[state]:
        order_guard.allow(order)
        assert order_guard.state == LEGAL[state][order]
        return
    with pytest.raises(OrderError) as error:
        order_guard.allow(order)
    legal = ", ".join(LEGAL[state]) or "none"
    assert str(error.value) == (
        f"water: when {state}, an order must be one of {legal}; found {order!r}."
    )
    assert order_guard.state == state


@pytest.mark.parametrize("window", [-1, 0, 2, 7])
def test_windows_come_in_order(window):
    order_guard = guard("ready")
    order_guard.allow("advance", 0)
    with pytest.raises(OrderError, match=f"window 1 is next; window {window} was ordered"):
        order_guard.allow("advance", window)
    order_guard.allow("advance", 1)


def test_rewind_needs_a_kept_state_and_comes_back_to_its_window():
    order_guard = guard("ready")
    with pytest.raises(OrderError, match="rewind needs a kept state; order keep first"):
        order_guard.allow("rewind")
    order_guard.allow("advance", 0)
    order_guard.allow("keep", 1)
    for _ in range(3):
        order_guard.allow("advance", 1)
        order_guard.allow("rewind", 1)
    order_guard.allow("advance", 1)
    with pytest.raises(OrderError, match="window 2 is next"):
        order_guard.allow("advance", 1)


def test_a_loaded_state_brings_its_window():
    order_guard = guard("ready")
    order_guard.allow("load", 40)
    with pytest.raises(OrderError, match="window 40 is next"):
        order_guard.allow("advance", 0)
    order_guard.allow("advance", 40)
