"""Garbage collection while kernels are compiled, one function within another."""

import gc

import pytest

from quintet.components.shared.compilation import PausedCollection


@pytest.mark.parametrize("enabled", [True, False])
def test_garbage_is_not_collected_while_a_kernel_is_compiled_and_after_it_as_before(enabled):
    original, paused = gc.isenabled(), PausedCollection()
    (gc.enable if enabled else gc.disable)()
    try:
        paused.on_start(None)
        paused.on_start(None)
        paused.on_end(None)
        during = gc.isenabled()
        paused.on_end(None)
        after = gc.isenabled()
    finally:
        (gc.enable if original else gc.disable)()
    assert not during
    assert after is enabled
