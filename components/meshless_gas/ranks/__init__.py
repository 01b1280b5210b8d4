"""A gas on one rank or on several, which share out its nodes.

Where nodes stand still, a rank holds its own nodes, those that its stencils reach, and all
boundary nodes with what their states follow from; after each stage it receives the states of those
that others advance. Where clouds move or particles act on the gas, every rank holds all nodes and
receives the states of all, but computes the rates of its own nodes alone. Either way boundaries,
walls and sums are computed in the order of one rank: no bit depends on the number of ranks.
"""
