"""A program of OpenCL C: structs and laws, each printed once for every set of types."""

import ast
import builtins
import inspect
import textwrap
from types import FunctionType
from typing import Any

from quintet.components.shared.opencl.expressions import Expressions
from quintet.components.shared.opencl.names import function_name, identifier
from quintet.components.shared.opencl.prelude import (
    Precision,
    power_function,
    prelude,
)
from quintet.components.shared.opencl.refusal import Place
from quintet.components.shared.opencl.statements import INDENT, Statements, locals_of
from quintet.components.shared.opencl.types import NONE, Record, Row, Type, type_of


class Program:
    """Laws in OpenCL C.

    Parameters
    ----------
    precision : "double" or "single"
        Of all floats; whole numbers have 64 bits.
    lanes : 1 or 4
        How many numbers those of the type `LANES` are, which are computed at once.

    Examples
    --------
    >>> from quintet.components.shared.smoothing.cubic_spline import shape
    >>> program = Program("double")
    >>> program.add(shape, 0.0)[0]
    'cubic_spline_shape'
    """

    def __init__(self, precision: Precision = "double", lanes: int = 1) -> None:
        self.precision: Precision = precision
        self._lanes = lanes
        self._functions: dict[tuple[Any, tuple[Type, ...]], tuple[str, Type]] = {}
        self._records: dict[Record, Record] = {}
        self._used: set[str] = set()
        self._structs: dict[str, str] = {}
        self._powers: dict[tuple[str, int], str] = {}
        self._printed: list[str] = []
        self._open: list[FunctionType] = []  # being printed

    def add(self, function: Any, *arguments: Any) -> tuple[str, Type]:
        """Print a law and the laws that it calls, unless they are there.

        Parameters
        ----------
        function : function
            Of Python, or as numba compiles it.
        *arguments
            An example of each: its type counts, and which of its fields are None.

        Returns
        -------
        str, Type
            Its name in C, and the type of its value. Arguments that are None are left out of calls.

        Raises
        ------
        PrintError
            With file, line, construct and what to do.
        """
        python: FunctionType = getattr(function, "py_func", function)
        kinds = tuple(self.add_type(type_of(argument)) for argument in arguments)
        if (python, kinds) not in self._functions:
            self._functions[python, kinds] = self._print(python, kinds)
        return self._functions[python, kinds]

    def struct(self, example: Any) -> str:
        """Name in C of the struct of a (named) tuple, which is printed."""
        return self.add_type(type_of(example)).name

    def add_power(self, kind: str, exponent: int) -> None:
        """Print a function that raises to a whole power."""
        self._powers[kind, exponent] = power_function(kind, exponent)

    def add_type(self, kind: Type) -> Type:
        """Print the struct of a type, and those of its fields; return it by its name in C."""
        if isinstance(kind, Row):
            kind = Row(tuple(map(self.add_type, kind.items)))
            fields = [(f"f{number}", field_kind) for number, field_kind in enumerate(kind.items)]
            self._add_struct(kind.name, fields)
            return kind
        if not isinstance(kind, Record):
            return kind
        if kind in self._records:
            return self._records[kind]
        named = tuple((name, self.add_type(field_kind)) for name, field_kind in kind.fields)
        record = Record(self._free_name(kind.name), named)
        self._add_struct(record.name, list(record.stored))
        self._records[kind] = self._records[record] = record
        return record

    @property
    def text(self) -> str:
        """The whole program, without kernels."""
        parts = [*self._structs.values(), *self._powers.values(), *self._printed]
        return "\n\n".join([prelude(self.precision, self._lanes), *parts]) + "\n"

    def _free_name(self, name: str) -> str:
        """Return a name that is not used yet."""
        number, candidate = 1, name
        while candidate in self._used:
            number += 1
            candidate = f"{name}_{number}"
        self._used.add(candidate)
        return candidate

    def _add_struct(self, name: str, fields: list[tuple[str, Type]]) -> None:
        if name not in self._structs:
            lines = [f"{INDENT}{kind.name} {identifier(field)};" for field, kind in fields]
            body = "\n".join(line for line in lines if " none " not in line)
            self._structs[name] = f"typedef struct {{\n{body}\n}} {name};"

    def _print(self, function: FunctionType, kinds: tuple[Type, ...]) -> tuple[str, Type]:
        definition, place = _parsed(function)
        if function in self._open:
            raise place.refuse(
                definition, f"{function.__name__}, which calls itself", "Write a loop."
            )
        parameters = [parameter.arg for parameter in definition.args.args]
        if len(parameters) != len(kinds) or _has_more(definition.args):
            raise place.refuse(
                definition, f"{len(kinds)} arguments for `{ast.unparse(definition.args)}`",
                "Pass one value for each parameter, by position and without defaults.",
            )  # fmt: skip
        types = dict(zip(parameters, kinds, strict=True))
        expressions = Expressions(self, place, _names_outside(function), types)
        statements = Statements(expressions, set(parameters))
        self._open.append(function)
        body = statements.print(definition.body)
        self._open.pop()
        assert statements.returned is not None
        name = self._free_name(function_name(function))
        used = [parameter for parameter in parameters if types[parameter] != NONE]
        declared = ", ".join(
            f"{types[parameter].name} {identifier(parameter)}" for parameter in used
        )
        head = f"static inline {statements.returned.name} {name}({declared}) {{"
        lines = [head, *locals_of(types, set(parameters)), *body, "}"]
        self._printed.append("\n".join(lines))
        return name, statements.returned


def _parsed(function: FunctionType) -> tuple[ast.FunctionDef, Place]:
    """Syntax tree of a function, and where it stands."""
    file = inspect.getsourcefile(function) or "?"
    lines, first = inspect.getsourcelines(function)
    place = Place(file, first, function.__name__)
    try:
        (tree,) = ast.parse(textwrap.dedent("".join(lines))).body
    except (SyntaxError, ValueError):
        tree = ast.Pass()
    if not isinstance(tree, ast.FunctionDef):
        raise place.refuse(None, "a lambda, or no function", "Define it with def.")
    return tree, place


def _has_more(arguments: ast.arguments) -> bool:
    """Whether a function has parameters that cannot be passed by position."""
    return bool(arguments.vararg or arguments.kwarg or arguments.kwonlyargs)


def _names_outside(function: FunctionType) -> dict[str, Any]:
    """Values of names outside of a function: of enclosing functions, its module and Python."""
    outside = inspect.getclosurevars(function).nonlocals
    return {**vars(builtins), **function.__globals__, **outside}
