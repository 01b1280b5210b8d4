"""Neighbours of one particle copied side by side: those of a list, or azimuthal images of rings."""

from numba.extending import overload

from quintet.components.shared.packing import out_of_reach, pack_rows
from quintet.components.sph_solid.kernels.azimuthal_images import (
    AzimuthalImages,
    pack_images,
    pack_images_of_stress,
)


def _are_images(lists):  # type: ignore[no-untyped-def]
    return lists.instance_class is AzimuthalImages


def across(lists):  # type: ignore[no-untyped-def]
    """1; 0 of rings: images at ±φ cancel along y, and one of the two is listed."""


@overload(across, inline="always")
def _across(lists):  # type: ignore[no-untyped-def]
    if _are_images(lists):
        return lambda lists: 0.0
    return lambda lists: 1.0


def pack_particles(i, lists, place, motion, law, near, moves):  # type: ignore[no-untyped-def]
    """Copy places and motion of the neighbours of a particle; return how many, filled up."""


@overload(pack_particles, inline="always")
def _pack_particles(i, lists, place, motion, law, near, moves):  # type: ignore[no-untyped-def]
    def of_lists(i, lists, place, motion, law, near, moves):  # type: ignore[no-untyped-def]
        begin, end, neighbour = lists.begin[i], lists.end[i], lists.neighbour
        outside = out_of_reach(place[i, 0], law.smoothing.length), place[i, 1], place[i, 2], 0.0
        pack_rows(begin, end, neighbour, place, outside, near)
        still = motion[i, 0], motion[i, 1], motion[i, 2], motion[i, 3]
        return pack_rows(begin, end, neighbour, motion, still, moves)

    def of_images(i, lists, place, motion, law, near, moves):  # type: ignore[no-untyped-def]
        outside = out_of_reach(place[i, 0], law.smoothing.length)
        return pack_images(i, lists, place, motion, outside, near, moves)

    return of_images if _are_images(lists) else of_lists


def pack_stresses(i, lists, stress, row, count, tension):  # type: ignore[no-untyped-def]
    """Copy rows of stress of the neighbours of a particle, filled up to `count` with its own."""


@overload(pack_stresses, inline="always")
def _pack_stresses(i, lists, stress, row, count, tension):  # type: ignore[no-untyped-def]
    def of_lists(i, lists, stress, row, count, tension):  # type: ignore[no-untyped-def]
        pack_rows(lists.begin[i], lists.end[i], lists.neighbour, stress, row, tension)

    def of_images(i, lists, stress, row, count, tension):  # type: ignore[no-untyped-def]
        pack_images_of_stress(i, lists, stress, row, count, tension)

    return of_images if _are_images(lists) else of_lists
