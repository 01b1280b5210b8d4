"""Mooring lines: elastic cables between anchors and floating bodies, at rest in still water.

A line of length L, stiffness EA and weight w per length in water hangs as an elastic catenary
between its anchor and its fairlead, the point where it is made fast to the body. H and V are the
horizontal and the vertical pull at the fairlead, V_a = V - w L that at the anchor:

    x = H/w (asinh(V/H) - asinh(V_a/H)) + H L/EA
    z = 1/w (√(H² + V²) - √(H² + V_a²)) + (V² - V_a²)/(2 w EA)

Where V < w L, a line whose anchor stands on the bed lies on it for a length L - V/w, without
friction: there V_a = 0, and x is longer by L - V/w. A line without weight is straight, and pulls
with EA (d/L - 1) where its ends are further apart than L. Lines have no mass and no drag: their
pull follows from where the fairleads are.

Papers: Irvine, Cable Structures (1981); Jonkman, NREL/TP-500-41958 (2007), section 2.3.
"""

from quintet.components.mooring_lines.joins import refuse_joins
from quintet.components.mooring_lines.params import MooringLinesParams
from quintet.components.mooring_lines.plan import plan
from quintet.components.mooring_lines.ports import SHOWS, ports
from quintet.interfaces.manifest import Manifest

__all__ = ["MANIFEST", "MooringLinesParams"]

MANIFEST = Manifest(
    kind="mooring_lines",
    title="Elastic cables that hold floating bodies to anchors",
    params=MooringLinesParams,
    component="quintet.components.mooring_lines.component:MooringLines",
    ports=ports,
    shows=SHOWS,
    plan=plan,
    joins=refuse_joins,
    bench="quintet.components.mooring_lines.bench:cases",
    conform="quintet.components.mooring_lines.conform:cases",
)
