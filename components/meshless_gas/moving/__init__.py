"""Bodies in the gas, each with a cloud of nodes that goes with it.

Imported only by scenes that have such bodies.
"""
