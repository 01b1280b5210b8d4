"""Tables of numbers beside a scene: CSV with the names of the columns in the first line."""

import csv
from pathlib import Path

import numpy as np

from quintet.interfaces.component import Array


def read_csv(file: str, where: str) -> tuple[list[str], Array]:
    """Names of the columns of a table, and its numbers (rows, columns).

    Parameters
    ----------
    where : str
        What an error calls the table; the name of its file is added.

    Raises
    ------
    ValueError
        Where the file cannot be read, a line has other columns than the first, or a cell below the
        first line is no number.
    """
    try:
        # Spreadsheets may write a byte order mark before the first name.
        with open(file, newline="", encoding="utf-8-sig") as text:
            lines = csv.reader(text)
            rows = [(lines.line_num, row) for row in lines if row]
        if len(rows) < 2:
            raise ValueError(f"{len(rows)} lines")
        (_, head), *rows = rows
        for line, row in rows:
            if len(row) != len(head):
                raise ValueError(f"{len(row)} cells in line {line}, and {len(head)} names")
        return [cell.strip() for cell in head], np.array(
            [[float(number) for number in row] for _, row in rows]
        )
    except (OSError, ValueError, csv.Error) as error:
        raise ValueError(
            f"{where} {Path(file).name} must have a line with the names of its columns, then lines "
            f"of numbers with a decimal point, separated by commas; found {error}. Correct it."
        ) from error
