"""Lateral sloshing with impact, SPHERIC test 10: scene and measured motion of the tank."""
