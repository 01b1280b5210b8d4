"""What the fluid meets: walls, surfaces that move, obstacles, planes of symmetry, films in gaps."""
