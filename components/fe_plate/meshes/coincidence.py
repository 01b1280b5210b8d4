"""Nodes at the same place, and pieces of a mesh that share no node.

Elements are joined by the nodes that they share. Parts that were meshed one by one only seem to be
joined where their nodes lie at the same places: each moves, and conducts heat, for itself.
"""

from itertools import product

import numpy as np

from quintet.components.fe_plate.meshes.arrays import Array, Whole

NEAR = 1e-4  # of the shortest edge: nodes that are so near to each other coincide


def first_at_place(node: Array, shortest: float) -> Whole:
    """Number of the first node (n,) at the place of each.

    Parameters
    ----------
    node : (n, 3), m
    shortest : float, m
        Edge of the elements; nodes nearer to each other than `NEAR` of it coincide.
    """
    width = 2.0 * NEAR * shortest
    first: Whole = np.arange(len(node))
    # What is nearer than half a width shares a cell of one of eight lattices.
    for shift in product((0.0, 0.5), repeat=3):
        cell = np.floor((node - node.min(axis=0)) / width + shift).astype(np.int64)
        _, number = np.unique(cell, axis=0, return_inverse=True)
        first = with_pairs(first, number.reshape(-1))
    return first


def with_pairs(first: Whole, group: Whole) -> Whole:
    """Join the classes, told by the first member (n,) of each, of all members of a group (n,)."""
    lowest = np.full(int(group.max()) + 1, len(first))
    while True:
        before = first
        np.minimum.at(lowest, group, first)
        joined = first.copy()
        np.minimum.at(joined, first, lowest[group])
        first = joined[joined[joined]]
        if np.array_equal(first, before):
            return first


def pieces(corner: Whole, nodes: int) -> int:
    """Number of pieces of a mesh that share no node with each other."""
    first: Whole = np.arange(nodes)
    while True:
        before = first
        lowest = first[corner].min(axis=1)
        joined = first.copy()
        np.minimum.at(joined, corner, lowest[:, None])
        first = joined[joined[joined]]
        if np.array_equal(first, before):
            return len(np.unique(first[corner]))
