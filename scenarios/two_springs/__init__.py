"""Two masses on springs: the scene of the tutorial, and its component."""
