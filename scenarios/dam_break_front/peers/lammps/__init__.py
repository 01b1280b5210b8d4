"""The dam break by the SPH package of LAMMPS: its input and runs."""
