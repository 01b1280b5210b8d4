"""How long this process has waited for other ranks of its component, for those who measure it."""


class Waited:
    """Seconds since the process began."""

    seconds = 0.0


WAITED = Waited()
