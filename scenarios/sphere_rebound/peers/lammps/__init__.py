"""The impacts of spheres by the GRANULAR package of LAMMPS: its input and runs."""
