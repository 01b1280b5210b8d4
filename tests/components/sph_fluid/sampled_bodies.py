"""Samples of boxes and spheres, for tests of the fluid around them."""

from quintet.components.shared.geometry.surface_samples_solid import (
    box_images,
    fill_box,
    fill_sphere,
    sphere_images,
)

BOX, SPHERE = "box", "sphere"


def fill(shape, size, spacing, depth):
    """Samples of a box, or of a sphere."""
    if shape == BOX:
        return fill_box(size, spacing, depth)
    return fill_sphere(size[0], spacing, depth)


def mirrors(shape, size, arm, normal):
    """Images of samples of a box, or of a sphere."""
    if shape == BOX:
        return box_images(size, arm, normal)
    return sphere_images(size[0], arm, normal)
