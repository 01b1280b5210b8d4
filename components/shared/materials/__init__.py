"""Elastic-plastic solids under shocks: strength, equation of state, fracture, and a library.

    σ = -p I + s,   ds/dt = 2G dev D + W s - s W (Jaumann),   √(3/2 s:s) ≤ Y(ε_p, dε_p/dt, T)
    p = p_r(μ) + (γ₀ + a μ) ρ₀e,   μ = ρ/ρ₀ - 1,   de = (s:D - p div v)/ρ dt

Compression is positive in p. Laws take one `Solid` of numbers, and what varies from point to point
as scalars, so that solvers of particles and of elements share them.
"""
