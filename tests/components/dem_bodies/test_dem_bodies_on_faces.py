"""Energy of spheres that touch the faces of a partner's mesh."""

import numpy as np
import pytest

from quintet.components.dem_bodies.component import DemBodies
from quintet.components.dem_bodies.conform import cases
from quintet.components.dem_bodies.params import DemBodiesParams
from quintet.interfaces.params import read

CASE = next(case for case in cases() if case.name == "spheres on a face")
PRESSED = 2e-4  # m, by which the face rises


def test_what_friction_with_faces_takes_is_dissipated():
    bodies = [{**body, "velocity": [1.0, 0.0, 0.0]} for body in CASE.params["bodies"]]
    params, mistakes = read(DemBodiesParams, {**CASE.params, "bodies": bodies}, "bodies")
    assert not mistakes
    solver = DemBodies(params)
    ports = {"contact_faces", "contact_activity", "contact_load", "motion"}
    solver.bind(CASE.static, frozenset(ports))
    solver.prime(CASE.rest)
    face = CASE.rest["contact_faces.position"] + np.array([0.0, 0.0, PRESSED])
    totals = []
    for _ in range(100):
        solver.take({**CASE.rest, "contact_faces.position": face})
        solver.step(1e-5)
        totals.append(solver.totals())
    lost = [total.dissipated for total in totals]
    energies = [total.kinetic + total.internal for total in totals]
    assert lost[-1] > lost[0] >= 0.0
    # The face has done all its work before the first of these.
    assert energies[1] - energies[-1] == pytest.approx(lost[-1] - lost[1], rel=0.02)
