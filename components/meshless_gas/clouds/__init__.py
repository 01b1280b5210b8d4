"""Clouds of nodes: where they are, what each is, and which are near to each."""
