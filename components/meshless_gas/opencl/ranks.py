"""A gas shared out among ranks that have a device each; imported only by a gas of several ranks.

The host's gas knows which rows ranks exchange. These are copied to the host, exchanged as on
processors, and copied back.
"""

from collections.abc import Callable

import numpy as np

from quintet.components.meshless_gas.build import Domain
from quintet.components.meshless_gas.component import MeshlessGas
from quintet.components.meshless_gas.opencl.changed_rows import ChangedRows
from quintet.components.meshless_gas.opencl.device_cloud import INDEX
from quintet.components.meshless_gas.opencl.device_state import DeviceState
from quintet.components.meshless_gas.opencl.parts import DevicePart
from quintet.components.meshless_gas.ranks.several import Exchanged, SeveralRanks
from quintet.components.shared.opencl.arrays import DeviceArray


class DeviceRanks(DevicePart):
    """Exchange of states between the devices of one gas.

    Parameters
    ----------
    gas : MeshlessGas
        The host's part of the gas; its states are overwritten.
    state : DeviceState
        States of this rank on its device.
    """

    def __init__(self, gas: MeshlessGas, state: DeviceState) -> None:
        self.gas, self.state, self._changed = gas, state, ChangedRows(state)
        self._domain: Domain | None = None  # whose rows these are
        self._follow()

    def _follow(self) -> None:
        """Update the exchanged rows if the nodes were divided among the ranks again."""
        domain, ranks = self.gas.motion.domain, self.gas.all_ranks
        assert isinstance(ranks, SeveralRanks)
        if self._domain is not domain:
            self._domain = domain
            self._advanced = ExchangedRows(ranks.exchanged(domain), self.state)
            self._boundaries = ExchangedRows(ranks.exchanged_boundaries(), self.state)

    def finish_stage(self) -> None:
        """Bring the states that other ranks advanced, where this rank needs them."""
        self._follow()
        domain, ranks = self.gas.motion.domain, self.gas.all_ranks
        self._exchange(
            self._advanced, lambda: ranks.exchange(domain, self.gas.fluxes.primitive)
        )  # fmt: skip

    def write_walls(self) -> None:
        """Bring the states of boundary nodes that other ranks computed."""
        ranks = self.gas.all_ranks
        self._exchange(
            self._boundaries, lambda: ranks.exchange_boundaries(self.gas.fluxes.primitive)
        )

    def _exchange(self, rows: "ExchangedRows", exchange: Callable[[], None]) -> None:
        """Copy rows to send from the device, exchange them, and copy received rows to it."""
        primitive, state = self.gas.fluxes.primitive, self.state
        primitive[rows.exchanged.sent] = rows.get(state.primitive)
        exchange()
        received = rows.exchanged.received
        self._changed.put(state.primitive, received, primitive[received])


class ExchangedRows:
    """Rows that a rank sends and receives.

    Parameters
    ----------
    exchanged : Exchanged
    state : DeviceState
    """

    def __init__(self, exchanged: Exchanged, state: DeviceState) -> None:
        self.exchanged, self.state = exchanged, state
        self._rows = DeviceArray.of(state.queue, exchanged.sent.astype(INDEX))
        self._values = DeviceArray(state.queue, (len(exchanged.sent), 5))

    def get(self, table: DeviceArray) -> np.ndarray:
        """Read the rows (m, 5) of a table that are sent."""
        count = len(self.exchanged.sent)
        sizes = map(np.int32, (count, 5, table.shape[0], 0))
        self.state.run("read_rows", 5 * count, *sizes, self._rows, table, self._values)
        return self._values.get()
