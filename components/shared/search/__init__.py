"""Finding what is near: sorting into cells, lists of neighbours, and how long lists hold."""
