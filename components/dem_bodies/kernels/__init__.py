"""Loops over bodies and pairs, compiled: lists, contacts, steps."""
