"""Steps in time: one pass over pairs with extrapolated densities, or two of second order."""
