"""What follows from a scene before there are particles: checks, geometry, counts, a first wave."""
