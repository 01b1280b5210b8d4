"""A body that conducts heat: steady, or stepped by Alexander's scheme."""

import math

import numpy as np

from quintet.components.fe_plate.heat import MANIFEST, diagnostics, features
from quintet.components.fe_plate.heat.build import build, hold, initial_state
from quintet.components.fe_plate.heat.kernels import conduct, solve
from quintet.components.fe_plate.heat.params import FeHeatParams
from quintet.components.fe_plate.heat.ports import SHOWS
from quintet.components.fe_plate.heat.view import view
from quintet.components.fe_plate.meshes.arrays import Array
from quintet.components.fe_plate.meshes.mesh import faces_in
from quintet.components.shared.finite_items import require_finite_items
from quintet.components.shared.geometry.surface_samples_mesh import mesh_answer
from quintet.components.shared.search.nearest import nearest_rows
from quintet.interfaces.component import Component, Fields, Keys, Totals
from quintet.interfaces.errors import SceneError


class FeHeat(Component):
    """Finds the temperatures of a body from fixed temperatures and heat fluxes.

    Parameters
    ----------
    params : FeHeatParams
        Parts, fixed temperatures, fluxes.
    """

    Params: type[FeHeatParams] = FeHeatParams
    manifest = MANIFEST
    shows = SHOWS

    def __init__(self, params: FeHeatParams) -> None:
        self.params, (self.takes, self.gives) = params, self.ports_of(params)
        self.model = build(params)
        mesh = self.model.mesh
        coupled = np.arange(len(mesh.side))
        if params.coupled_faces:
            coupled = faces_in(mesh, params.coupled_faces, "coupled_faces")
        if not len(coupled):
            raise SceneError(
                "coupled_faces: the boxes must hold an outer face; none does. Correct the boxes."
            )
        faces = mesh.side[coupled]
        self.surface = np.unique(faces)  # nodes
        self.corner = np.searchsorted(self.surface, faces)  # (f, 4) among these
        self.gauges = nearest_rows(mesh.node, params.node_gauges)
        self.state = initial_state(params, self.model, len(self.surface))
        self.times = diagnostics.transient_times(params, self.model)  # s
        self.conduction = features.conduction(params, self.model, self.times)
        self.is_compiled = False

    def describe(self) -> Fields:
        """State where the nodes of the surface are, and the corners of its faces."""
        return {
            "node_temperature.start": self.model.mesh.node[self.surface],
            "node_temperature.corner": self.corner.astype(np.float64),
        }

    def sample(self, request: Fields) -> Fields:
        """Hang points on the faces of the surface."""
        return mesh_answer("node_temperature", request, self.describe())

    def _compile(self) -> None:
        """Compile without iterations: a trial step of a steady problem would solve all of it."""
        self.is_compiled = True
        still = self.state.temperature.copy()
        flow = np.zeros_like(still)
        solve(self.model.conductance, flow, self.model.free, flow, still, math.inf, 0)
        conduct(self.model.conductance, still, flow)

    def stable_dt(self) -> float:
        """Return the step that the scene says; all are stable."""
        if not self.is_compiled:
            self._compile()
        return self.params.longest_step or math.inf

    def take(self, fields: Fields) -> None:
        """Set the heat [W] that enters at nodes of the surface; without it none."""
        heat = fields.get("node_heat.heat_flow")
        self.state.heat[:] = 0.0 if heat is None else heat

    def step(self, dt: float) -> None:
        """Advance by exactly dt [s], or find what is steady."""
        self.check()  # else the solver would only not converge
        load = self.model.source.copy()
        load[self.surface] += self.state.heat
        gained = self.conduction.advance(self.state, dt, load)
        held = self.model.holder >= 0
        flow = np.bincount(self.model.holder[held], -gained[held], len(self.state.held))
        self.state.held[:] = flow
        self.state.outside[0] += dt * float(flow.sum() + self.model.source.sum())

    def check(self) -> None:
        """Refuse a node whose temperature is not finite."""
        nodes = self.model.mesh.node
        fields = {"temperature": self.state.temperature}
        advice = "Check the heat that enters there."
        require_finite_items("node", fields, np.arange(len(nodes)), nodes, advice)

    def give(self, wanted: Keys) -> Fields:
        """Copy out temperatures and heat flows."""
        temperature, model = self.state.temperature, self.model
        values: dict[str, Array] = {}
        if "node_temperature.temperature" in wanted:
            values["node_temperature.temperature"] = temperature[self.surface]
        if "parts.temperature" in wanted:
            weighed = np.bincount(model.part, model.volume * temperature)
            values["parts.temperature"] = weighed / np.bincount(model.part, model.volume)
        if "held.heat_flow" in wanted:
            values["held.heat_flow"] = self.state.held.copy()
        if "node_gauge.temperature" in wanted:
            values["node_gauge.temperature"] = temperature[self.gauges]
        return values

    def save(self) -> Fields:
        """Copy out all state."""
        return {name: array.copy() for name, array in self.state._asdict().items()}

    def load(self, state: Fields) -> None:
        """Restore a saved state, bit for bit."""
        for name, array in self.state._asdict().items():
            array[:] = state[name]

    def begin_from(self, state: Fields) -> None:
        """Begin from the state of another run, with the fixed temperatures of this one.

        Transients are judged from now on.
        """
        is_same = len(state["held"]) == len(self.state.held)
        super().begin_from(state if is_same else {**state, "held": self.state.held})
        hold(self.params, self.model, self.state.temperature)
        self.state.start[:] = self.state.temperature
        self.state.judged[:] = 0.0

    def totals(self) -> Totals:
        """Mass, heat above 0 K, and heat of sources and held nodes; steady parts store none."""
        return diagnostics.totals(self.params, self.model, self.state)

    def warnings(self) -> dict[str, str]:
        """Steps too long to resolve the transient of a part."""
        return diagnostics.warnings(self.state.judged, self.times)

    def notes(self) -> tuple[str, ...]:
        """Sizes of meshes from files, and what of them is left out."""
        return self.model.mesh.notes

    def view(self) -> Fields:
        """Outer faces with their temperatures."""
        return view(self.model.mesh, self.state.temperature)

    def items(self) -> int:
        """Count the elements."""
        return len(self.model.mesh.corner)
