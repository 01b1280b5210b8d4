"""``quintet scaling FILE``: predict from measurements that ``quintet bench --json`` left."""

import argparse

from quintet.coupler.bench.scaling import read_rows, scalings_of
from quintet.coupler.bench.scaling_report import KEYS, report
from quintet.coupler.files.json_file import JsonFile


def run_scaling(options: argparse.Namespace) -> int:
    """Print, draw and write what the file's models predict."""
    wanted = JsonFile(options.json, KEYS)
    wanted.write(report(scalings_of(read_rows(options.file), options), options))
    return 0
