"""What a kind tells of how it begins is what the component says once it is built."""

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
        told = manifest.initial(trial.params)
        instants = frozenset(trial.outputs.keys() & told.keys()) - trial.impulses
        said = {**component.describe(), **component.give(instants)}
        assert told and told.keys() <= said.keys() and instants
        for key, array in told.items():
            np.testing.assert_allclose(array, said[key], rtol=1e-12, atol=1e-15, err_msg=key)
        if manifest.plan:
            assert manifest.plan(trial.params).items == component.items()
