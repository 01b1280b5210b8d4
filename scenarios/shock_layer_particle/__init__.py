"""A particle crosses the shock layer of a sphere."""
