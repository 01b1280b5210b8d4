"""The initial fields that a kind declares are those of the component once it is built."""

import numpy as np
import pytest

from quintet.components.sph_fluid.conform import DROP, MIRRORED
from quintet.coupler.conform.trial import Trial
from quintet.interfaces.manifest import ConformCase, find


@pytest.mark.parametrize("kind", ["dem_bodies", "prescribed", "replay"])
def test_a_kind_foretells_how_its_component_begins_and_how_large_it_is(kind, tmp_path):
    manifest = find(kind)
    for number, case in enumerate(manifest.conform_cases()):
        folder = tmp_path / str(number)
        folder.mkdir()
        trial = Trial(manifest, case, folder)
        component = trial.build()
        initial = manifest.initial(trial.params)
        instants = frozenset(trial.outputs.keys() & initial.keys()) - trial.impulses
        outputs = {**component.describe(), **component.give(instants)}
        assert initial and initial.keys() <= outputs.keys() and instants
        for key, array in initial.items():
            np.testing.assert_allclose(array, outputs[key], rtol=1e-12, atol=1e-15, err_msg=key)
        if manifest.plan:
            assert manifest.plan(trial.params).items == component.items()


def test_a_fluid_describes_what_it_foretells_and_keeps_its_water_apart(tmp_path):
    manifest = find("sph_fluid")
    falling = {"gravity": [0.0, 0.0, -9.81], "sound_speed": 50.0}
    table = DROP | MIRRORED | falling | {"remove_inside_bodies": True}
    trial = Trial(manifest, ConformCase("drop", table), tmp_path)
    described, initial = trial.build().describe(), manifest.initial(trial.params)
    assert initial and initial.keys() <= described.keys()
    for key, array in initial.items():
        np.testing.assert_array_equal(array, described[key], err_msg=key)
    (box,) = trial.params.boxes
    water = manifest.surroundings(trial.params)
    np.testing.assert_array_equal([water["water_lowest"][0], water["water_highest"][0]], box)
