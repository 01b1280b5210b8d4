"""Components that take a solver's place in a run.

``replay`` repeats the outputs of a recorded component; ``prescribed`` moves rigid bodies on given
paths whatever the loads on them, and can return these loads; ``echo`` returns its inputs, to
measure the exchange.
"""

from quintet.components.stand_ins.params import EchoParams, PrescribedParams, ReplayParams
from quintet.components.stand_ins.params import echo_ports as _echo_ports
from quintet.components.stand_ins.params import prescribed_ports as _prescribed_ports
from quintet.components.stand_ins.recorded import recorded_plan, recorded_ports, recorded_start
from quintet.interfaces.component import Fields
from quintet.interfaces.manifest import Manifest
from quintet.interfaces.ports import MOTION


def _prescribed(params: PrescribedParams) -> Fields:
    # Only a scene that has one imports it.
    from quintet.components.stand_ins.prescribed import Prescribed

    bodies = Prescribed(params)
    motion = frozenset(f"motion.{field.name}" for field in MOTION.fields)
    return {**bodies.describe(), **bodies.give(motion)}


REPLAY = Manifest(
    kind="replay",
    title="a recorded component, again",
    params=ReplayParams,
    component="quintet.components.stand_ins.replay:Replay",
    ports=recorded_ports,
    plan=recorded_plan,
    initial=recorded_start,
    conform="quintet.components.stand_ins.conform:replay",
)
PRESCRIBED = Manifest(
    kind="prescribed",
    title="rigid bodies on given paths",
    params=PrescribedParams,
    component="quintet.components.stand_ins.prescribed:Prescribed",
    ports=_prescribed_ports,
    initial=_prescribed,
    conform="quintet.components.stand_ins.conform:prescribed",
)
ECHO = Manifest(
    kind="echo",
    title="gives back what it takes",
    params=EchoParams,
    component="quintet.components.stand_ins.echo:Echo",
    ports=_echo_ports,
    conform="quintet.components.stand_ins.conform:echo",
)
