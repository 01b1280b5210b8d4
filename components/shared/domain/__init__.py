"""One solver on several MPI ranks: who owns what, what crosses the borders, sums of all rows.

Results do not depend on the number of ranks. Each rank computes the rows that it owns and has
copies of the rows near them, the halo. Cells are anchored to the world, minima and maxima are
exact, sums are formed of whole cells and then of cells in order, and rows have persistent ids.
Only a component of several ranks imports what stands here: it needs mpi4py.
"""
