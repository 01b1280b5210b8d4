"""Loops over walls and surface samples; those of one method are imported with it."""
