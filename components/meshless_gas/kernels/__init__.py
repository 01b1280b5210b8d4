"""Loops over nodes: gradients, residuals, boundaries, steps in time.

Arguments that mean the same in all loops, those of `moving` and `viscous` included; n nodes with
their ghosts, w wall nodes, b bodies, K neighbours:

    first, last    range of `rows` that one thread computes
    rows           (m,) or (w,) nodes whose results are written
    positions      (n, 3) m
    normals        (n, 3) 1, into the gas
    spacing        (n,) m
    neighbours     (n, K), padded with the node itself
    coefficients   (n, K, 3) 1/m, of the gradient
    primitive      (n, 5) kg/m3, m/s, Pa: density, velocity, pressure
    residual       (n, 5) kg/(m3 s), N/m3, W/m3: rates of density, momentum, energy
    patches        (p, PATCH_COLUMNS), states that the scene gives boundaries
    planar         True where y is left out; None in space or about an axis
    above          (w, 2) the two nodes above each wall node
    velocity       (w, 3) m/s, of the walls
    centres, radii (b, 3) m and (b,) m
    gamma, law     1, and a `Transport`
"""
