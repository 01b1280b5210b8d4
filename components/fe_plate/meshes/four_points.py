"""Quadrature points of a tetrahedron with ten nodes: at λ = OWN of a corner and REST of the others.

The rule with four points is exact for squares (Hammer, Marlowe and Stroud 1956).
"""

import math

OWN, REST = 0.25 + 0.15 * math.sqrt(5.0), 0.25 - 0.05 * math.sqrt(5.0)
