"""All elements on one rank."""

from collections.abc import Mapping, Sequence

from quintet.components.fe_plate.build import Structure
from quintet.components.fe_plate.meshes.mesh import Mesh
from quintet.components.fe_plate.ranks.method import Rows
from quintet.components.fe_plate.state import Array, State, Whole
from quintet.components.shared.exact_sums import bounds, sum_parts, total

ALL = slice(None)


class Here:
    """Rows that are all on this rank."""

    def gather(self, rows: Array) -> Array:
        """Return the rows."""
        return rows

    def give(self, rows: Sequence[Array]) -> Sequence[Array]:
        """Return the rows."""
        return rows


class OneRank:
    """A structure whose state is all there is."""

    rank = 0

    def share_out(self, built: Structure) -> Structure:
        """Keep all."""
        nodes, elements = len(built.mesh.node), len(built.mesh.corner)
        self.nodes, self.elements = Rows(nodes, ALL, ALL, Here()), Rows(elements, ALL, ALL, Here())
        return built

    def mesh_to_keep(self, mesh: Mesh) -> Mesh:
        """Return the mesh."""
        return mesh

    def mesh_to_show(self, mesh: Mesh, built: Structure) -> Mesh:
        """Return the mesh."""
        return mesh

    def nodes_of(self, numbers: Whole) -> Rows:
        """All of a list (k,)."""
        return Rows(len(numbers), numbers, ALL, Here())

    def elements_of(self, numbers: Whole) -> Rows:
        """All of a list (k,)."""
        return Rows(len(numbers), numbers, ALL, Here())

    def begin(self, state: State) -> None:
        """Nothing to do: no others move nodes."""

    def finish(self, state: State) -> None:
        """Nothing to do: no others move nodes."""

    def copy_velocities(self, state: State) -> None:
        """Nothing to do: no others move nodes."""

    def least(self, numbers: Array) -> Array:
        """Return the numbers."""
        return numbers

    def greatest(self, numbers: Array) -> Array:
        """Return the numbers."""
        return numbers

    def sums(self, columns: Sequence[Array]) -> Array:
        """Sum the columns."""
        count = self.nodes.size + self.elements.size
        return total(sum_parts(columns, bounds(columns), count))

    def lowest(self, row: Array) -> Array:
        """Return the row."""
        return row

    def whole(self, state: State) -> dict[str, Array]:
        """Copies of all arrays to save."""
        return {name: array.copy() for name, array in state.to_save().items()}

    def restore(self, state: State, saved: Mapping[str, Array]) -> None:
        """Take all saved arrays."""
        for name, array in state.to_save().items():
            array[:] = saved[name]
