"""Rows of bodies on one MPI rank or shared out among several."""
