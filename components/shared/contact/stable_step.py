"""The stable step of two solvers in contact, from those of each alone."""

HALVINGS = 60


def highest_square(alone: tuple[float, float], added: tuple[float, float]) -> float:
    """Bound of the square of the highest frequency [1/s²] of two solvers in contact.

    No frequency of a whole exceeds the highest of its parts, whatever share of the masses each part
    has (Irons & Treharne, Proc. 3rd Conf. on Matrix Methods in Struct. Mech., 1971, 119). A share s
    of the masses at the interface is put to contact. A layer of elements, or of particles, that has
    half of its mass there keeps 1 - s of that half, and its ω² grows to Λ/2 (1 + 1/(1-s)); that of
    contact is Σ c/s over both sides. The shares for which all three are equal give the bound. It is
    exact for a single layer that is touched on one side. One that is touched on both has all of its
    mass at the interface, and its ω may exceed the bound by 8 %, which the link's default `safety`
    of 0.9 covers; with Λ/(1-s), of a layer with all of its mass at the interface, it
    would be Λ + Σ c.

    Parameters
    ----------
    alone : two float, 1/s2
        Λ = ω² of each side alone; 0 of bodies that are free without contact.
    added : two float, 1/s2
        c: what contact adds to ω² of masses of each side, were the other one at rest.
    """
    low = max(alone)
    high = low + sum(added)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _of_contact(middle, alone, added) > middle else (low, middle)
    return high


def _of_contact(square: float, alone: tuple[float, float], added: tuple[float, float]) -> float:
    """Σ c/s of the shares s at which both sides alone reach a square frequency [1/s²]."""
    total = 0.0
    for square_alone, more in zip(alone, added, strict=True):
        spare = 2.0 * (square - square_alone)
        if more > 0.0 and not spare > 0.0:
            return float("inf")
        total += more * (spare + square_alone) / spare if more > 0.0 else 0.0
    return total
