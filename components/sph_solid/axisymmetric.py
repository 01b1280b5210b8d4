"""Lists of the azimuthal images of rings about the z axis; only for axisymmetric scenes."""

import numpy as np

from quintet.components.shared.threads import Team
from quintet.components.sph_solid.kernels.azimuthal_images import (
    CLOSE,
    AzimuthalImages,
    image_counts,
    list_images,
    turn_table,
)
from quintet.components.sph_solid.neighbours import SolidLists
from quintet.components.sph_solid.state import State

ROOM = 80  # images that there is room for near each ring, at first


class ImageLists:
    """Images of rings that are near each ring, with a smoothing length [m]."""

    def __init__(self, length: float, team: Team) -> None:
        self.length, self.team = length, team
        self.most, self.room = 0, ROOM  # images in the table, and near a ring
        none, empty = np.zeros(0, np.int64), np.zeros(0, np.int32)
        self.images = AzimuthalImages(none, none, empty, empty, turn_table(0))

    def __call__(self, state: State, lists: SolidLists) -> AzimuthalImages:
        """List images of the rings that are near in the plane."""
        numbers = image_counts(lists.points[:, 0], self.length)
        most, count = int(numbers.max()), state.particles
        if most > self.most:
            self.most = 2 * most
            self.images = self.images._replace(turn=turn_table(self.most))
        begin, end = np.empty(count, np.int64), np.empty(count, np.int64)
        while True:
            size = self.room * count
            if len(self.images.ring) < size:
                ring, row = np.empty(size, np.int32), np.empty(size, np.int32)
                self.images = self.images._replace(ring=ring, row=row)
            self.images = self.images._replace(begin=begin, end=end)
            counts = self.team.run(
                list_images, count, lists.points, numbers, state.reach, CLOSE * self.length,
                lists.arrays, self.room, self.images,
            )  # fmt: skip
            if max(counts) <= self.room:
                return self.images
            self.room = 2 * max(counts)
