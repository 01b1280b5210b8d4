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
        Where the file cannot be read, or a cell below the first line is no number.
    """
    try:
        with open(file, newline="", encoding="utf-8") as text:
            head, *rows = [row for row in csv.reader(text) if row]
        return [cell.strip() for cell in head], np.array(
            [[float(number) for number in row] for row in rows]
        )
    except (OSError, ValueError, csv.Error) as error:
        raise ValueError(
            f"{where} {Path(file).name} must have a line with the names of its columns, then lines "
            f"of numbers; reading it found {error}. Correct it."
        ) from error
