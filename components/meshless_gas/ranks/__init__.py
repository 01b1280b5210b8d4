"""A gas on one rank or on several, which share out its nodes.

If nodes stand still, a rank holds its own nodes, the nodes in its stencils, all boundary nodes, and
the nodes from which boundary states are computed. After each stage it receives the states of the
nodes that other ranks advance. Where clouds move or particles act on the gas, every rank holds all
nodes and receives the states of all, but computes the rates of its own nodes alone. Either way
boundaries, walls and sums are computed in the order of one rank: no bit depends on the number of
ranks.
"""
