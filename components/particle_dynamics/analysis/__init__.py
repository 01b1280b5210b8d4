"""Tools that examine a lattice from outside; the solver imports none of them."""
