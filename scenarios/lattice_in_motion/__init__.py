"""A free lattice in thermal motion: scene, exact end, error of integrators against time."""
