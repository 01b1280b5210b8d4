"""The command line: one module for each group of commands."""

from quintet.coupler.cli.commands import main, parser

__all__ = ["main", "parser"]
