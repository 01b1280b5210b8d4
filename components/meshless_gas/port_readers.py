"""Which functions compute the fields of each port."""

from collections import defaultdict
from collections.abc import Iterable

from quintet.components.meshless_gas.diagnostics import balance, errors
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.parts import NodeMotion, Part, Reader
from quintet.components.meshless_gas.ranks.one import Ranks
from quintet.components.meshless_gas.state import Fluxes, State
from quintet.components.shared.threads import Team


def port_readers(
    params: MeshlessGasParams,
    state: State,
    work: Fluxes,
    motion: NodeMotion,
    parts: Iterable[Part],
    team: Team,
    ranks: Ranks,
) -> dict[str, list[Reader]]:
    """Readers by port; a port has several where parts know some of its fields each."""
    readers: dict[str, list[Reader]] = defaultdict(list)
    readers["balance"] = [lambda: balance(params, state, motion.domain, work, team, ranks)]
    readers["error"] = [lambda: errors(params, state, motion.domain, team, ranks)]
    for part in parts:
        for port, reader in part.readers(work.primitive).items():
            readers[port].append(reader)
    return readers
