"""Physics of one pair of nodes and of one wall: fluxes, limiters, transport."""
