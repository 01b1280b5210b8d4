"""Texts of kernels that several solvers share, and names by which kernels call printed laws."""

from pathlib import Path
from typing import Any

from quintet.components.shared.opencl.program import Program

HERE = Path(__file__).parent


def kernels(*names: str, folder: Path = HERE) -> list[str]:
    """Texts of the files ``name.cl`` in a folder; of those beside this one by default."""
    return [(folder / f"{name}.cl").read_text() for name in names]


def named(program: Program, name: str, law: Any, *arguments: Any, returns: str = "") -> str:
    """Print a law and define its name for kernels; `returns` names the struct that it returns."""
    printed_name, kind = program.add(law, *arguments)
    lines = [f"#define {name} {printed_name}"]
    if returns:
        lines.append(f"#define {returns} {kind.name}")
    return "\n".join(lines)
