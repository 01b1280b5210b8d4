"""The points of a lattice on one rank or shared out among several; both do the same to a bit.

Points belong to the rank on which they start. A rank holds its points and copies of those near
them, in the order of their numbers: it computes what pairs of its points do in the order in which
one rank would. The copies are held as frozen points are; they are placed before each computation
of forces.
"""
