"""Names by which the kernels of a gas call printed laws."""

from typing import Any

from quintet.components.shared.opencl.program import Program


def named(program: Program, law: Any, *arguments: Any) -> str:
    """Print a law, and let kernels call it by its own name."""
    python = getattr(law, "py_func", law)
    return f"#define {python.__name__} {program.add(law, *arguments)[0]}"
