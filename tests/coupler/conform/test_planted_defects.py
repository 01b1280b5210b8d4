"""The broken law finds each planted defect, and a sound component has no finding."""

import pytest
import toy_defects  # noqa: F401  (it plants)
import toy_late_defects  # noqa: F401
from toy_planting import PLANTED
from toy_sound import Sound

from quintet.coupler.conform.check import try_all
from quintet.coupler.conform.laws import LAWS, name_of
from quintet.coupler.conform.trial import Trial
from quintet.interfaces.manifest import manifest_of


def findings(cls, folder):
    """All findings about a class, of all its cases."""
    manifest = manifest_of(cls, f"{cls.__module__}:{cls.__name__}")
    for case in cls.conform_cases():
        for _, finding in try_all(Trial(manifest, case, folder)):
            if finding is not None:
                yield finding


def test_a_sound_component_breaks_no_law_and_every_law_applies_to_it(tmp_path):
    results = list(findings(Sound, tmp_path))
    assert [finding for finding in results if finding.status == "failed"] == []
    assert {finding.law for finding in results if finding.status == "passed"} == {
        name_of(law) for law in LAWS
    }


@pytest.mark.parametrize("cls", PLANTED, ids=lambda cls: cls.__name__)
def test_a_defect_breaks_the_law_that_it_should(cls, tmp_path):
    failed = {
        finding.law: finding.said
        for finding in findings(cls, tmp_path)
        if finding.status == "failed"
    }
    assert name_of(PLANTED[cls]) in failed


def test_every_law_can_be_broken():
    assert set(PLANTED.values()) == set(LAWS)
