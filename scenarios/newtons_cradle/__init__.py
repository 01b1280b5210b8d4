"""A bar between two baths: scene, conductivity that does not depend on its length."""
