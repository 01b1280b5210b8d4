"""Parallel efficiencies that other codes have published, beside which a prediction is drawn."""

from typing import Literal, NamedTuple


class Published(NamedTuple):
    """Efficiency of a code on some numbers of cores."""

    code: str
    scaling: Literal["strong", "weak"]
    cores: tuple[float, float]  # fewest and most; or times those at the start
    efficiency: tuple[float, float]  # at both, or lowest and highest between them if `within`
    within: bool
    text: str
    source: str


PUBLISHED = (
    Published(
        "LOGOS",
        "strong",
        (24.0, 96.0),
        (0.58, 0.70),
        True,
        "58 to 70 % on 24 to 96 cores",
        "Dyanov, Kazantsev, Chelakov: SPH for high-strain-rate deformation; its base is not given",
    ),
    Published(
        "SWIFT",
        "strong",
        (1.0, 512.0),
        (1.0, 0.60),
        False,
        "over 60 % on 512 times the cores that it began on",
        "Schaller et al., arXiv 1606.02738",
    ),
    Published(
        "SWIFT",
        "weak",
        (1.0, 4096.0),
        (1.0, 0.75),
        False,
        "loses 25 % from 1 to 4096 cores",
        "Borrow et al., arXiv 1807.01341",
    ),
)
