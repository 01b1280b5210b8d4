"""Collection of garbage while kernels are compiled, function within function."""

import gc

import pytest

from quintet.components.shared.compilation import PausedCollection


@pytest.mark.parametrize("before", [True, False])
def test_garbage_is_not_collected_while_a_kernel_is_compiled_and_after_it_as_before(before):
    was, paused = gc.isenabled(), PausedCollection()
    (gc.enable if before else gc.disable)()
    try:
        paused.on_start(None)
        paused.on_start(None)
        paused.on_end(None)
        within = gc.isenabled()
        paused.on_end(None)
        after = gc.isenabled()
    finally:
        (gc.enable if was else gc.disable)()
    assert not within
    assert after is before
