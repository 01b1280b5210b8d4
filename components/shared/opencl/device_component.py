"""A component whose steps run on an OpenCL device.

A component of the same kind on the host makes the rows, and answers whatever reads them: outputs,
totals, views, checks, snapshots. The rows are copied into its state before.
"""

from abc import abstractmethod
from collections.abc import Mapping

from quintet.interfaces.component import Component, Fields, Keys, Totals


class DeviceComponent(Component):
    """Steps on a device, and lets its host answer all else.

    Derived classes make `host` and the device's rows, step, and copy rows both ways. A step sets
    `_is_read` to False.
    """

    compiles = True
    host: Component
    _is_read = False  # whether the host's state is that of the device

    @abstractmethod
    def _put(self) -> None:
        """Copy the host's state to the device."""

    @abstractmethod
    def _read(self) -> None:
        """Copy the device's rows into the host's state."""

    def _get(self) -> None:
        """Copy the device's rows into the host's state, unless they are there."""
        if not self._is_read:
            self._read()
            self._is_read = True

    def _is_finite(self) -> bool:
        """Whether all numbers that steps do not check are finite, as the device finds it."""
        return True

    def describe(self) -> Fields:
        """State the static fields of the host."""
        self._get()
        return self.host.describe()

    def bind(self, static: Fields, joined: Keys) -> None:
        """Let the host join its ports."""
        self.host.bind(static, joined)

    def prime(self, fields: Fields) -> None:
        """Let the host learn what its inputs are as the run begins."""
        self._get()
        self.host.prime(fields)
        self._put()

    def stable_dt(self) -> float:
        """Largest step [s], from what the last one told the host."""
        return self.host.stable_dt()

    def take(self, fields: Fields) -> None:
        """Set the inputs of the host."""
        self.host.take(fields)

    def check(self) -> None:
        """Let the host name an item whose state is not finite."""
        if self._is_read or not self._is_finite():
            self._get()
            self.host.check()

    def give(self, wanted: Keys) -> Fields:
        """Copy out the outputs that are wanted."""
        if wanted:
            self._get()
        return self.host.give(wanted)

    def save(self) -> Fields:
        """Copy out all state, as the kind on the processor has it."""
        self._get()
        return self.host.save()

    def load(self, state: Fields) -> None:
        """Come back to a state that was saved on a processor or on a device."""
        self.host.load(state)
        self._put()

    def begin_from(self, state: Fields) -> None:
        """Begin from the state of another run, on a processor or on a device."""
        self._get()
        self.host.begin_from(state)
        self._put()

    def totals(self) -> Totals:
        """Mass, momentum and energies."""
        self._get()
        return self.host.totals()

    def view(self) -> Fields:
        """What pictures and ParaView show of the present state."""
        self._get()
        return self.host.view()

    def walls(self) -> Fields:
        """What stands still around it, for pictures."""
        return self.host.walls()

    def notes(self) -> tuple[str, ...]:
        """Sentences of the host that the user should read."""
        return self.host.notes()

    def warnings(self) -> Mapping[str, str]:
        """Reasons of the host why the results may be wrong; by default from what it knows now."""
        return self.host.warnings()

    def final_warnings(self) -> Mapping[str, str]:
        """Warnings that only the whole run can justify."""
        self._get()
        return self.host.final_warnings()

    def items(self) -> int:
        """Count the items of the host."""
        return self.host.items()
