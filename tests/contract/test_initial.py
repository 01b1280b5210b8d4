"""The initial fields that a kind declares are those of the component once it is built."""

import numpy as np
import pytest

from quintet.coupler.conform.trial import Trial
from quintet.interfaces.manifest import find


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
