"""A bar between a hot and two cold baths of one point each: scene, exact on the lattice's graph."""
