"""Kernels of the structure: elements in blocks, a vector of them at once, and nodes."""
