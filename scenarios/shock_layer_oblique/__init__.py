"""A particle leaves a sphere at 35 degrees to its axis, in three dimensions."""
