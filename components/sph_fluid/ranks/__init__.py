"""A fluid on one rank or shared out among several; both compute the same to the bit.

Several ranks cut space between layers of the cells that neighbours are searched in. A rank owns
the fluid of its part, and walls and samples that look into it. Behind its own rows stand copies of
those of others that are near, then images in planes of symmetry; a list has its neighbours in the
order in which one rank has them. All ranks have the surfaces' fields, and rank 0 answers.
"""
