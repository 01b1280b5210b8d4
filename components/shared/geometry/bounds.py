"""Types of what shapes give and take: corners of the box that holds one, and what is inside."""

from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from quintet.interfaces.params import Number, Vector

Bounds = tuple[Vector, Vector]  # lowest and highest corner, m
Corners = Annotated[tuple[tuple[Number, Number], ...], Field(max_length=1000)]
Mask = NDArray[np.bool_]
ORIGIN = (0.0, 0.0, 0.0)
