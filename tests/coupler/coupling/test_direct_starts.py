"""A taker requests how large a partner's items may be; a direct link refuses larger ones."""

import numpy as np
import pytest

from quintet.coupler.coupling.links import maker
from quintet.interfaces.component import Field, Port

WIDTH, LARGEST = Field("width", (), "m"), Field("largest_width", (), "m")
PORTS = {
    "a": ((), (Port("grains", (WIDTH,)),)),
    "b": ((Port("grains", (WIDTH,), "partner", requests=(LARGEST,)),), ()),
}


def _refused(widths, largest):
    link = maker("direct")(0, {"name": "rope", "pairs": [["a.grains", "b.grains"]]}, PORTS)
    initial = {"a": {}, "b": {}}
    if widths is not None:
        initial["a"] = {"grains.width": np.array(widths)}
    if largest is not None:
        initial["b"] = {"grains.largest_width": np.array([largest])}
    return link.refusals(initial)


def test_items_larger_than_the_taker_can_take_are_refused():
    (message,) = _refused([0.1, 0.3, 0.2], 0.25)
    assert message == (
        "link rope: a.grains.width must be at most 0.25 m, as b.grains.largest_width requests; "
        "found 0.3 m of item 1. Correct a or b."
    )


@pytest.mark.parametrize(
    ("widths", "largest"), [([0.1, 0.25], 0.25), ([], 0.25), (None, 0.25), ([9.0], None)]
)
def test_items_that_fit_or_are_not_known_yet_are_not(widths, largest):
    assert _refused(widths, largest) == []
