"""Loops over nodes of a gas with friction; common arguments as in `meshless_gas.kernels`."""
