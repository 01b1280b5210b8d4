"""Loops over the nodes of bodies' clouds; common arguments as in `meshless_gas.kernels`."""
