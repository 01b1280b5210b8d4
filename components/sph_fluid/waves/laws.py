"""Physics of damping at one point; numbers, or arrays of them."""


def damping_strength(place, low, high, is_lower):  # type: ignore[no-untyped-def]
    """ξ² at a place [m] between the ends of a zone [m], which damps most at its lower or upper end.

    References
    ----------
    Altomare et al., Coast. Eng. 127 (2017) 37.
    """
    share = (place - low) / (high - low)
    if is_lower:
        share = 1.0 - share
    return share * share


def damped_share(strength, rate, dt):  # type: ignore[no-untyped-def]
    """Share of a velocity that is left after a step dt [s] of du/dt = -rate ξ² u, implicitly."""
    return 1.0 / (1.0 + rate * dt * strength)
