"""A fixed cloud in the memory of a device: nodes, stencils, boundaries, copied once."""

import numpy as np

from quintet.components.meshless_gas.build import Domain
from quintet.components.shared.opencl.arrays import DeviceArray
from quintet.components.shared.opencl.tables import Tables

INDEX = np.int32  # of a node


class DeviceCloud:
    """Arrays of a fixed cloud; no step changes them.

    Parameters
    ----------
    domain : Domain
    tables : Tables
    """

    def __init__(self, domain: Domain, tables: Tables) -> None:
        cloud, (neighbours, coefficients) = domain.cloud, domain.stencils
        self.nodes, self.whole, self.width = cloud.nodes, *neighbours.shape
        self.ghosts = self.whole - self.nodes
        self.neighbours = tables.of(neighbours, INDEX)
        self.coefficients = tables.of(coefficients)  # 1/m, 3 of each neighbour
        self.positions = tables.of(cloud.positions)  # m
        self.normals, self.areas = tables.of(cloud.normals), tables.of(cloud.areas)
        rows = (domain.inner, domain.edges, domain.bounding, domain.mirrored)
        self.inner, self.edges, self.bounding, self.mirrored = (
            self._whole_numbers(tables, numbers) for numbers in rows
        )
        self.kind, self.patch = (
            self._whole_numbers(tables, numbers) for numbers in (cloud.kind, cloud.patch)
        )
        self.weights = tables.of(domain.weights)
        self.patches = DeviceArray.of(tables.queue, domain.patches)  # by rows
        planes = domain.outflows
        self.outflows = self._whole_numbers(tables, planes.rows)
        self.near = tables.of(planes.near, INDEX)
        self.planes = tables.of(planes.weights)
        self.owner = self._whole_numbers(tables, cloud.owner)
        self.turn = DeviceArray.of(tables.queue, cloud.turn)  # by rows

    @staticmethod
    def _whole_numbers(tables: Tables, numbers: np.ndarray) -> DeviceArray:
        return DeviceArray.of(tables.queue, numbers.astype(INDEX))
