"""A gas on one rank or on several, which share out its nodes.

Every rank has the states of all nodes. Ranks share out the loops over neighbours: each computes
the rates of its own nodes, and of gradients those that it needs. Then all learn the states of all
nodes. The rest, boundaries and walls and sums, each rank computes from the same states: no bit
depends on the number of ranks. Where nodes stand still, a rank keeps only the stencils that it
needs; those of clouds that move and cut holes in each other are on every rank.
"""
