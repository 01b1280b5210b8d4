"""Contacts: which pairs may touch, which do, and the forces between them."""
