"""Cards of LS-DYNA keyword files: keywords, formats, includes, and the fields of a line.

Source: LS-DYNA Keyword User's Manual, volume I, "Getting started": fixed columns of 8, 10 and 16
characters, of 20 with `long=y` or + behind a keyword, of 10 in place of 8 with `i10=y` or %, and
free format on each line that has a comma.
"""

import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple, NoReturn, TypeVar

from quintet.interfaces.errors import SceneError

Value = TypeVar("Value", int, float)
STANDARD, TEN, LONG = "standard", "ten", "long"
MARKS = {"+": LONG, "%": TEN, "-": STANDARD}  # behind a keyword
DEEPEST = 16  # files within each other
MOST = 2**63 - 1  # whole numbers of arrays
EXPONENT = re.compile(r"(?<=[\d.])[dDeE]?([+-]\d+)$")  # 1.5-3 and 1.5d-3 are 1.5e-3


class Card(NamedTuple):
    """A line of a file, its fields in a format."""

    file: str
    line: int
    text: str
    form: str = STANDARD

    def refuse(self, rule: str, finding: str, cure: str) -> NoReturn:
        """Raise an error with the file and the number of the line."""
        raise SceneError(f"file {self.file}, line {self.line}: {rule}; found {finding}. {cure}")

    def fields(self, widths: tuple[int, ...]) -> list[str]:
        """Cut the line into fields: at its commas, or in columns of standard widths."""
        if "," in self.text:
            fields = [field.strip() for field in self.text.split(",")]
        else:
            if "\t" in self.text:
                rule = "a line without commas has its fields in fixed columns"
                self.refuse(rule, "a tab character", "Write spaces, or commas.")
            fields, begin = [], 0
            for width in widths:
                if self.form == LONG:
                    width = 20
                elif self.form == TEN and width == 8:
                    width = 10
                fields.append(self.text[begin : begin + width].strip())
                begin += width
        return fields + [""] * (len(widths) - len(fields))

    def whole(self, field: str, name: str) -> int:
        """Whole number in a field; 0 if it is blank."""
        number = _parsed(int, field)
        if number is None or abs(number) > MOST:
            cure = "Correct it, or the columns that it stands in."
            self.refuse(f"{name} must be a whole number of 64 bits", field, cure)
        return number

    def number(self, field: str, name: str) -> float:
        """Return the number in a field; 0 if it is blank."""
        number = _parsed(float, field)
        if number is None:
            number = _parsed(float, EXPONENT.sub(r"e\1", field))
        if number is None or not math.isfinite(number):
            cure = "Correct it, or the columns that it stands in."
            self.refuse(f"{name} must be a finite number", field, cure)
        return number

    def numbers(self, fields: list[str], names: str) -> list[float]:
        """Return the numbers of some fields, which have names in one text."""
        pairs = zip(fields, names.split(), strict=True)
        return [self.number(field, name) for field, name in pairs]


class Block(NamedTuple):
    """A keyword and the cards below it, comments left out."""

    keyword: str  # in capitals, without the asterisk
    head: Card
    cards: list[Card]


def _parsed(kind: Callable[[str], Value], field: str) -> Value | None:
    """Return the number in a field, 0 if it is blank; None if it is none, as Python's 1_1."""
    try:
        return None if "_" in field else kind(field or "0")
    except ValueError:
        return None


def blocks(path: Path) -> list[Block]:
    """Read the keywords of a file and of its included files, in order."""
    all_blocks: list[Block] = []
    _read(path, path.parent.resolve(), STANDARD, (), all_blocks)
    return all_blocks


def _read(
    path: Path, folder: Path, form: str, within: tuple[Path, ...], blocks: list[Block]
) -> None:
    """Append the blocks of a file; `within`: the files that include it."""
    current, name = None, path.name
    for line, text in enumerate(path.read_text(errors="replace").splitlines(), 1):
        card = Card(name, line, text.rstrip(), form)
        if text.startswith("$"):
            continue
        if not text.startswith("*"):
            if current is not None:
                card_of_block = card._replace(form=current.head.form)
                current.cards.append(card_of_block)
                if current.keyword == "INCLUDE" and text.strip():
                    _include(card_of_block, path, folder, within, blocks)
            elif text.strip():
                rule = "data must stand below a keyword"
                card.refuse(rule, text.strip()[:40], "Give a file of LS-DYNA keywords.")
            continue
        keyword, mark = _keyword(text)
        if keyword == "END":
            return
        if keyword == "KEYWORD":
            form = _form(card, text)
        current = Block(keyword, card._replace(form=MARKS.get(mark, form)), [])
        if keyword.startswith("INCLUDE_"):
            rule = "files are included by *INCLUDE alone"
            card.refuse(rule, f"*{keyword}", "Write what it includes into one file.")
        if keyword != "INCLUDE":
            blocks.append(current)


def _keyword(text: str) -> tuple[str, str]:
    """Name of a keyword in capitals, and the mark of its format."""
    words = text[1:].upper().split()
    name = words[0].split(",")[0] if words else ""
    mark = words[1] if len(words) > 1 and words[1] in MARKS else ""
    if name and name[-1] in MARKS:
        name, mark = name[:-1], name[-1]
    return name, mark


def _form(card: Card, text: str) -> str:
    """Format that *KEYWORD sets for what follows."""
    options = text.lower().replace(" ", "").replace(",", "")
    if "long=" in options:
        if "long=y" in options:
            return LONG
        if "long=s" not in options:
            rule = "*KEYWORD has long=y, or the standard format"
            card.refuse(rule, text.strip(), "Write the file again in one of these.")
    return TEN if "i10=y" in options else STANDARD


def _include(
    card: Card, path: Path, folder: Path, within: tuple[Path, ...], blocks: list[Block]
) -> None:
    """Read a file that *INCLUDE names; it lies in the folder of the first one, or below."""
    name = card.text.strip()
    included = (path.parent / name).resolve()
    if not (included.is_relative_to(folder) and included.is_file()):
        rule = "*INCLUDE must name a file in the folder of the mesh's file, or below it"
        card.refuse(rule, name, "Put it there, or correct its name.")
    above = (*within, path.resolve())
    if included in above or len(above) > DEEPEST:
        card.refuse("a file must not include itself", name, "Remove the *INCLUDE.")
    _read(included, folder, card.form, above, blocks)
