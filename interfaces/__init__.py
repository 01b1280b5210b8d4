"""The contract between solvers and coupler; nothing here knows any solver.

What the author of a solver needs is exported here; ``README.md`` beside this file tells how to
write one.
"""

from quintet.interfaces.component import Array as Array
from quintet.interfaces.component import Component as Component
from quintet.interfaces.component import Field as Field
from quintet.interfaces.component import Fields as Fields
from quintet.interfaces.component import Keys as Keys
from quintet.interfaces.component import Port as Port
from quintet.interfaces.component import Resources as Resources
from quintet.interfaces.component import Totals as Totals
from quintet.interfaces.units import add_unit as add_unit
