"""Provenance of a reference: kind, publication, how its numbers were read, licence of its data."""

import re
from typing import Literal

ReferenceKind = Literal["", "exact", "experiment", "other code", "own finest run"]
ReadFrom = Literal[
    "", "formula", "conservation law", "text", "table", "digitised figure", "data file", "run"
]  # fmt: skip
NO_DOI = "none"  # of a reference whose publication has no DOI
DOI = re.compile(r"10\.\d{4,9}/\S+")
FOREIGN = ("experiment", "other code")  # kinds of references that others found
COMPUTED = ("conservation law", "run")  # no experiment is read from these


def provenance_rules(
    kind: str, read_from: str, doi: str, licence: str, csv: str | None
) -> list[tuple[bool, str]]:
    """Rules of what must be known about a reference: whether each is broken, and its sentence."""
    foreign = kind in FOREIGN
    return [
        (
            bool(doi) and doi != NO_DOI and not DOI.fullmatch(doi),
            f"doi must begin with 10., as 10.1098/rsta.1952.0006, or be {NO_DOI!r}; found {doi!r}. "
            "Give it without an address before it.",
        ),
        (
            foreign and not read_from,
            f"a reference of kind {kind} needs read_from. Say how its numbers were read.",
        ),
        (
            foreign and not doi and read_from != "run",
            f"a reference of kind {kind} needs doi. Give that of its publication, or {NO_DOI!r} if "
            "it has none.",
        ),
        (
            foreign and csv is not None and not licence,
            f"a curve of kind {kind} needs licence. Give that of the data, or say that none is "
            "stated.",
        ),
        (
            kind == "experiment" and read_from in COMPUTED,
            f"an experiment is not read from a {read_from}; correct reference_kind or read_from.",
        ),
    ]
