"""Bodies of particles on one rank or shared out among several; both compute the same to the bit.

Several ranks cut space between rows of cells, and each owns the particles of its part. Behind its
own rows stand copies of those of others that are near, then images in planes of symmetry. Signs of
wrong results are judged on rank 0, which gathers all particles for it.
"""
