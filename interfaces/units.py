"""The closed list of units that may cross a link: SI, one spelling each."""

from quintet.interfaces.errors import PortError

UNITS = frozenset(
    {
        "1", "s", "m", "m2", "m3", "kg", "kg m2", "kg/m3", "m/s", "m/s2", "rad/s", "1/s",
        "N", "N m", "N s", "N m s", "N/m", "Pa", "Pa s", "J", "W", "K", "J/K", "W/m2", "rad",
    }
)  # fmt: skip

# What an impulse field carries over a link: its integral over the window.
INTEGRATED = {"N": "N s", "N m": "N m s", "W": "J", "m/s": "m"}


def check_unit(unit: str, where: str, centring: str) -> None:
    """Refuse a unit outside the list, or one that has no integral where one is needed."""
    if unit not in UNITS:
        raise PortError(
            f"{where}: a unit must be one of {', '.join(sorted(UNITS))}; found {unit!r}. "
            "Give the field in one of these."
        )
    if centring == "impulse" and unit not in INTEGRATED:
        raise PortError(
            f"{where}: an impulse field must be in {', '.join(sorted(INTEGRATED))}; "
            f"found {unit!r}. Give its rate, or make it an instant field."
        )
