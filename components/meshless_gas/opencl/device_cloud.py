"""A cloud in the memory of a device: nodes, stencils, boundaries."""

import numpy as np

from quintet.components.meshless_gas.build import Domain
from quintet.components.shared.opencl.arrays import DeviceArray
from quintet.components.shared.opencl.tables import Tables

INDEX = np.dtype(np.int32)  # of a node


class DeviceCloud:
    """Arrays of a cloud; no step changes them, unless nodes go with bodies.

    Parameters
    ----------
    domain : Domain
    tables : Tables
    """

    def __init__(self, domain: Domain, tables: Tables) -> None:
        cloud, (neighbours, coefficients) = domain.cloud, domain.stencils
        self.tables = tables
        self.nodes, self.whole, self.width = cloud.nodes, *neighbours.shape
        self.ghosts = self.whole - self.nodes
        self.neighbours = tables.of(neighbours, INDEX)
        self.coefficients = tables.of(coefficients)  # 1/m, 3 of each neighbour
        self.positions = tables.of(cloud.positions)  # m
        self.normals, self.areas = tables.of(cloud.normals), tables.of(cloud.areas)
        rows = (domain.edges, domain.bounding, domain.mirrored, cloud.kind, cloud.patch)
        self.edges, self.bounding, self.mirrored, self.kind, self.patch = (
            self._whole_numbers(numbers) for numbers in rows
        )
        self.weights = tables.of(domain.weights)
        self.patches = DeviceArray.of(tables.queue, domain.patches)  # by rows
        self.owner = self._whole_numbers(cloud.owner)
        self.turn = DeviceArray.of(tables.queue, cloud.turn)  # by rows
        self.put_rows(domain)

    def put_rows(self, domain: Domain) -> None:
        """Copy which nodes are advanced or have gradients, and the planes at outflows."""
        planes = domain.outflows
        self.inner, self.every, self.outflows = map(
            self._whole_numbers, (domain.inner, domain.every, planes.rows)
        )
        self.near = self.tables.of(planes.near, INDEX)
        self.planes = self.tables.of(planes.weights)

    def put(self, domain: Domain) -> None:
        """Copy all that changes where nodes go with bodies, but for their places."""
        cloud, (neighbours, coefficients), put = domain.cloud, domain.stencils, self.tables.put
        put(self.neighbours, neighbours)
        put(self.coefficients, coefficients)
        put(self.weights, domain.weights)
        put(self.areas, cloud.areas)
        self.put_rows(domain)

    def _whole_numbers(self, numbers: np.ndarray) -> DeviceArray:
        return DeviceArray.of(self.tables.queue, numbers.astype(INDEX))
