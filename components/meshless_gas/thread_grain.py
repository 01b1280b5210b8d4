"""From how many rows on a loop is worth handing to another thread, which costs some 50 us."""

FEWEST = 256  # nodes, of loops over fluxes to their neighbours: 0.3 us each
SUMS = 2048  # nodes or ghosts, of loops that sum over neighbours or turn gradients: 0.04 us
LIGHT = 8192  # nodes or ghosts, of loops that only look at each by itself
WHOLESALE = 4096  # nodes, of operations on whole arrays
