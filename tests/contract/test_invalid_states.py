"""A number that is not finite ends the run in the window in which it arises, with the item."""

import re

import numpy as np
import pytest

from quintet.components.dem_bodies.state import OMEGA
from quintet.components.fe_plate.state import STRAIN
from quintet.coupler.conform.trial import Trial
from quintet.interfaces.lines.message import Message
from quintet.interfaces.manifest import find
from quintet.interfaces.serving.serve import Server, answer

STEPS, WINDOW = 3, 2  # steps of a window; the window in which a number is spoilt


def row_of(state, number):
    return int(np.flatnonzero(state.identity == number)[0])


def spoil_fluid(fluid):
    fluid.state.velocity_pressure[row_of(fluid.state, 3), 1] = np.nan


def spoil_solid(solid):
    solid.state.strain[row_of(solid.state, 3)] = np.nan


def spoil_energy(solid):
    solid.state.energy[row_of(solid.state, 5)] = np.inf


def spoil_body(bodies):
    bodies.state.motion[bodies.state.row[0], OMEGA] = np.nan


def spoil_gas(gas):
    gas.state.conservative[gas.motion.domain.inner[3], 4] = np.nan


def spoil_element(plate):
    point = int(plate.places.point[1, 0])
    plate.state.points[point // 16, STRAIN, point % 16] = np.nan


def spoil_node(plate):
    plate.state.temperature[4] = np.nan


def spoil_point(lattice):
    lattice.state.kinetic[7] = np.nan


def spoil_sphere(spheres):
    spheres.state.temperature[0] = np.nan


# Kind, function that spoils a number, step of the window after which it does so, message.
SPOILT = [
    ("sph_fluid", spoil_fluid, 3, "velocity must be finite; particle 3 at ("),
    ("sph_fluid", spoil_fluid, 1, "a fluid particle must stay finite.*particle 3 at ("),
    ("sph_solid", spoil_solid, 3, "plastic strain must be finite; particle 3 at ("),
    ("sph_solid", spoil_energy, 3, "specific energy must be finite; particle 5 at ("),
    ("dem_bodies", spoil_body, 3, "angular velocity must be finite; body 0 at ("),
    ("meshless_gas", spoil_gas, 1, "density and pressure must stay above 0; the node at ["),
    ("fe_plate", spoil_element, 3, "plastic strain must be finite; element 1 at ("),
    ("fe_heat", spoil_node, 3, "temperature must be finite; node 4 at ("),
    ("particle_lattice", spoil_point, 3, "kinetic energy must be finite; point 7 at ("),
    ("particle_spheres", spoil_sphere, 3, "temperature must be finite; sphere 0 at ("),
]


class Answers:
    """A line that keeps the last message."""

    def send(self, header, fields):
        self.header, self.fields = header, fields


@pytest.fixture
def serve_case(tmp_path):
    """Serve the first case of a kind; return the component and a function that orders windows."""

    def serve(kind):
        manifest = find(kind)
        trial = Trial(manifest, manifest.conform_cases()[0], tmp_path)
        component, line = trial.make(), Answers()
        server, case = Server(component, kind), trial.case

        def order(name, fields=(), **header):
            answer(server, line, Message({"order": name, **header}, dict(fields)))
            return line.header, line.fields

        order("describe")
        order("bind", trial.static(), joined=sorted(trial.joined))
        order("give")
        impulses = server.inputs.impulses
        instants = {k: v for k, v in trial.inputs().items() if k not in impulses}
        order("prime", instants)
        order("prepare")

        def window(number):
            dt = STEPS * min(case.dt, server.stable())
            fields = {k: dt * v if k in impulses else v for k, v in trial.inputs().items()}
            return order("advance", fields, window=number, dt=dt, ends=[], steps=STEPS)

        return component, window

    return serve


@pytest.mark.parametrize(("kind", "spoil", "step_number", "message"), SPOILT)
def test_a_spoilt_number_is_found_in_its_window(serve_case, kind, spoil, step_number, message):
    component, window = serve_case(kind)
    step, steps = type(component).step, []

    def spoiling(dt):
        step(component, dt)
        steps.append(dt)
        if len(steps) == step_number:
            spoil(component)

    for number in range(WINDOW):
        header, _ = window(number)
        assert header["order"] == "done", header
    component.step = spoiling
    header, fields = window(WINDOW)
    assert header["order"] == "failed" and header["error"] == "StepError"
    assert re.search(re.escape(message).replace(r"\.\*", ".*"), header["text"]), header["text"]
    assert len(steps) in (step_number, step_number + 1)
    assert len(header["place"]) == 3 and "points" in fields
