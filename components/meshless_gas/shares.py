"""From how many rows on a loop is worth handing to another thread, which costs some 50 us."""

FEWEST = 256  # nodes, of loops over their neighbours
LIGHT = 4096  # nodes or ghosts, of loops that only look at each by itself
WHOLESALE = 4096  # nodes, of operations on whole arrays
