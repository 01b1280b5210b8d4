"""Structures on one rank or shared out among several; both compute the same to the bit.

A mesh is shared out once, at the start, in whole blocks of elements: all elements of a block take
as many iterations to return to the flow stress. Each rank moves the nodes that it owns, and steps
all blocks with an element at one of them; some blocks are stepped by two ranks, to the same bits.
So only positions and velocities of nodes cross borders, once a step, while the longest run of
blocks without such nodes is stepped. Forces on a node are summed in the order of one rank.
"""
