"""Every component keeps the laws of the contract: the kinds' own cases, and toys of `cases.py`."""

import pytest
from cases import CASES

from quintet.coupler.conform.check import try_law
from quintet.coupler.conform.laws import LAWS, name_of
from quintet.coupler.conform.trial import Trial
from quintet.interfaces.manifest import find, known_kinds

PUBLISHED = [(kind, case) for kind in known_kinds() for case in find(kind).conform_cases()]


def test_every_installed_kind_publishes_cases():
    assert {kind for kind, _ in PUBLISHED} == known_kinds().keys()


@pytest.mark.parametrize("law", LAWS, ids=name_of)
@pytest.mark.parametrize(
    ("kind", "case"),
    [*PUBLISHED, *CASES.items()],
    ids=lambda parameter: parameter if isinstance(parameter, str) else parameter.name,
)
def test_law(kind, case, law, tmp_path):
    outcome = try_law(law, Trial(find(kind), case, tmp_path))
    assert outcome.status != "failed", outcome.said
