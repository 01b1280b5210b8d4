"""Smoothing kernels of particle methods, and the choice between them."""
