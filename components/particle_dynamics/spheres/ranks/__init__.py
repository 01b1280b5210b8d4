"""Spheres on one rank or shared out among several; both do the same to a bit.

Spheres that may strike each other are shared out by space, others in blocks of their numbers. Each
rank flies its own spheres and looks for impacts of them, also with copies of those of other ranks.
If there are impacts, the spheres in them and all near these are gathered on every rank, and every
rank carries the impacts out, one after another in the order of one rank. It then keeps what has
become of its own.
"""
