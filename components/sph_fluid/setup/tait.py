"""The equation of state, for checks that import no kernel: p = c² ρ₀/γ ((ρ/ρ₀)^γ - 1)."""

TAIT = 7  # γ, exponent of the equation of state
