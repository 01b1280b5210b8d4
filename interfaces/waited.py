"""How long this process has waited for other ranks of its component, and how much it sent them."""


class Waited:
    """Since the process began."""

    seconds = 0.0  # by the clock
    processor = 0.0  # s of the waiting thread: it polls, and gives the core to others meanwhile


class Traffic:
    """Messages of this rank since the process began."""

    messages = 0  # sent to single ranks
    message_bytes = 0  # in these
    collectives = 0  # operations of all ranks, whatever they carry
    gathered_bytes = 0  # rows of other ranks brought here, by collectives or in shared memory


WAITED = Waited()
TRAFFIC = Traffic()
