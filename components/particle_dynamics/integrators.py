"""Symplectic schemes of second and fourth order: their stages, and their greatest stable steps."""

YOSHIDA = 1.0 / (2.0 - 2.0 ** (1.0 / 3.0))
# Shares of a step; Yoshida, Phys. Lett. A 150 (1990) 262.
STAGES = {"velocity_verlet": (1.0,), "yoshida": (YOSHIDA, 1.0 - 2.0 * YOSHIDA, YOSHIDA)}
# Greatest stable step times the highest frequency; of Yoshida's where an oscillator's step matrix
# has a trace of -2.
LIMIT = {"velocity_verlet": 2.0, "yoshida": 1.5734}
