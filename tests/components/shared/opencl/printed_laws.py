"""Run a law on random arguments twice: compiled by numba, and printed for an OpenCL device."""

import dis
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from types import FunctionType
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numba.core.dispatcher import Dispatcher

from quintet.components.shared.opencl.devices import build, device_of, opencl
from quintet.components.shared.opencl.names import identifier
from quintet.components.shared.opencl.program import Program
from quintet.components.shared.opencl.types import (
    NONE,
    NUMBERS,
    REAL,
    Record,
    Row,
    Type,
    type_of,
)

ROWS = 300


class Between(NamedTuple):
    """A random argument; if `logarithmic`, each decade is equally likely."""

    low: float
    high: float
    logarithmic: bool = False


def vector(size: float) -> tuple[Between, ...]:
    """Return three random numbers between -size and size."""
    return (Between(-size, size),) * 3


@dataclass
class Law:
    """A law and its arguments: numbers, tuples and named tuples, some of them random.

    `ulp` is the largest difference of results, in units of the last place of the larger one. If the
    law `cancels` digits, it is the last place of the largest number among arguments and results.
    """

    function: Any
    arguments: tuple[Any, ...]
    ulp: int = 0
    name: str = field(default="")
    cancels: bool = False

    def __post_init__(self) -> None:
        python = getattr(self.function, "py_func", self.function)
        module = python.__module__.removeprefix("quintet.components.")
        self.name = f"{module}.{python.__name__}{self.name}"


def example(argument: Any) -> Any:
    """Return the argument with its random parts replaced by fixed numbers."""
    if isinstance(argument, Between):
        return argument.low
    return map_items(example, argument) if isinstance(argument, tuple) else argument


def map_items(function: Callable[[Any], Any], values: Any) -> Any:
    """Apply a function to the items of a (named) tuple."""
    items = map(function, values)
    return type(values)(*items) if hasattr(values, "_fields") else tuple(items)


def draw(argument: Any, random: np.random.Generator) -> Any:
    """Draw the random parts of an argument."""
    if isinstance(argument, Between):
        low, high, logarithmic = argument
        if logarithmic:
            return float(np.exp(random.uniform(np.log(low), np.log(high))))
        return float(random.uniform(low, high))
    if isinstance(argument, tuple):
        return map_items(lambda item: draw(item, random), argument)
    return argument


def leaves(value: Any) -> Iterator[float]:
    """Numbers of a value, in the order of its struct."""
    if isinstance(value, tuple):
        for item in value:
            yield from leaves(item)
    elif value is not None:
        yield float(value)


def compile_law(law: Any) -> Any:
    """Compile a law and the laws that it calls by numba; no sum is reordered."""
    python = getattr(law, "py_func", law)
    if python not in _compiled:
        # Names of fields are no globals, even if a law has the same name.
        names = {
            instruction.argval
            for instruction in dis.get_instructions(python)
            if instruction.opname == "LOAD_GLOBAL"
        }
        laws = {
            name: compile_law(python.__globals__[name])
            for name in names
            if isinstance(python.__globals__.get(name), Dispatcher)
        }
        strict = FunctionType(
            python.__code__, {**python.__globals__, **laws}, closure=python.__closure__
        )
        _compiled[python] = njit(error_model="numpy")(strict)
    return _compiled[python]


_compiled: dict[Any, Any] = {}


def run_by_numba(law: Law, rows: list[tuple[Any, ...]]) -> np.ndarray:
    """Results (rows, numbers) computed by numba."""
    function = compile_law(law.function)
    return np.array([list(leaves(function(*row))) for row in rows])


def run_on_device(
    laws: list[Law], drawn_rows: list[list[Any]], precision: str = "double"
) -> list[Any]:
    """Results (rows, numbers) of each law computed by the device, with one program."""
    cl, queue = opencl(), device_of("opencl").queue()
    program, kernels, real = Program(precision), [], np.float64  # type: ignore[arg-type]
    real = np.float64 if precision == "double" else np.float32
    widths = []
    for number, law in enumerate(laws):
        name, kind = program.add(law.function, *map(example, law.arguments))
        text, width = kernel_of(program, law, name, kind, number)
        kernels.append(text)
        widths.append(width)
    compiled_program = build(queue, program.text + "\n".join(kernels), precision)
    results = []
    for number, rows in enumerate(drawn_rows):
        inputs = np.array([list(leaves(row)) for row in rows], real)
        outputs = np.empty((len(rows), widths[number]), real)
        flags = cl.mem_flags
        input_buffer = cl.Buffer(
            queue.context, flags.READ_ONLY | flags.COPY_HOST_PTR, hostbuf=inputs
        )
        output_buffer = cl.Buffer(queue.context, flags.WRITE_ONLY, size=outputs.nbytes)
        getattr(compiled_program, f"run_{number}")(
            queue, (len(rows),), None, input_buffer, output_buffer
        )
        cl.enqueue_copy(queue, outputs, output_buffer)
        results.append(outputs)
    return results


def kernel_of(program: Program, law: Law, name: str, kind: Type, number: int) -> tuple[str, int]:
    """Print a kernel that calls a law for a row of arguments; also return its number of results."""
    kinds = [program.add_type(type_of(example(argument))) for argument in law.arguments]
    place = iter(range(10**6))
    codes = [struct(input_kind, place) for input_kind in kinds if input_kind != NONE]
    inputs = next(place)
    fields = list(paths(kind, "value"))
    stores = "".join(f"    out[{len(fields)} * i + {k}] = {f};\n" for k, f in enumerate(fields))
    text = (
        f"__kernel void run_{number}(__global const real *in, __global real *out) {{\n"
        f"    const size_t i = get_global_id(0);\n    in += {inputs} * i;\n"
        f"    const {kind.name} value = {name}({', '.join(codes)});\n{stores}}}\n"
    )
    return text, len(fields)


def struct(kind: Type, place: Iterator[int]) -> str:
    """Code that makes an argument from the next numbers of the input."""
    if kind in NUMBERS:
        number = f"in[{next(place)}]"
        return number if kind == REAL else f"({kind.name}){number}"
    assert isinstance(kind, Row | Record)
    parts = kind.items if isinstance(kind, Row) else [part for _, part in kind.stored]
    return f"(({kind.name}){{{', '.join(struct(part, place) for part in parts)}}})"


def paths(kind: Type, path: str) -> Iterator[str]:
    """Code of each number of a value."""
    if isinstance(kind, Row | Record):
        numbered = [(f"f{k}", part) for k, part in enumerate(getattr(kind, "items", ()))]
        for name, part in kind.stored if isinstance(kind, Record) else numbered:
            yield from paths(part, f"{path}.{identifier(name)}")
    else:
        yield path


def ulps(first: np.ndarray, second: np.ndarray, scale: Any = 0.0) -> float:
    """Largest difference, in units of the last place of the larger number, or of a scale."""
    different = ~((first == second) | (np.isnan(first) & np.isnan(second)))
    scale = np.broadcast_to(scale, first.shape)[different]
    first, second = first[different], second[different]
    largest = np.maximum(np.maximum(np.abs(first), np.abs(second)), scale)
    return float((np.abs(first - second) / np.spacing(largest)).max(initial=0.0))


def scale_of(law: Law, rows: list[tuple[Any, ...]], results: np.ndarray) -> Any:
    """Scale (rows, 1) of a law's differences: 0, or the largest number of a row if it cancels."""
    if not law.cancels:
        return 0.0
    largest = [max(map(abs, leaves(row))) for row in rows]
    return np.maximum(np.abs(results).max(axis=1), largest)[:, np.newaxis]
