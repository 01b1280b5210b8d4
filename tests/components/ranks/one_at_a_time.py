"""A check that a device never holds two sets of rows of a solver at once."""

from weakref import WeakSet


def one_at_a_time(kind):
    """Let a class refuse to make an object while another of the same queue is alive."""
    alive, initialize = WeakSet(), kind.__init__

    def initialize_alone(self, queue, *arguments):
        assert all(rows.queue is not queue for rows in alive), "former rows are still held"
        alive.add(self)
        initialize(self, queue, *arguments)

    kind.__init__ = initialize_alone
