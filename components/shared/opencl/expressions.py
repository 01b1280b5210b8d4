"""Expressions of a law in OpenCL C; parts that are known as it is printed are left out."""

import ast
import inspect
import types as python_types
from typing import Any, Protocol

from quintet.components.shared.opencl.calls import ONE_LANE, PASS_NUMBERS, c_name, intrinsic
from quintet.components.shared.opencl.functions import ARITHMETIC, BITWISE, ROUNDED_DOWN
from quintet.components.shared.opencl.names import identifier
from quintet.components.shared.opencl.prelude import Precision, power_name
from quintet.components.shared.opencl.refusal import Place, PrintError
from quintet.components.shared.opencl.truths import combined, compared
from quintet.components.shared.opencl.types import (
    FLAG,
    INT,
    LANES,
    MASK,
    NONE,
    NUMBERS,
    REAL,
    Record,
    Row,
    Type,
    unified,
)
from quintet.components.shared.opencl.values import Value, converted, literal, row, struct_of


class Printer(Protocol):
    """Methods of a program that the expressions of its laws call."""

    precision: Precision

    def add(self, function: Any, *arguments: Any) -> tuple[str, Type]:
        """Print a function for types of arguments; return its name and the type of its value."""

    def add_power(self, kind: str, exponent: int) -> None:
        """Print a function that raises to a whole power."""

    def add_type(self, kind: Type) -> Type:
        """Print the struct of a type; return the type by its name in C."""


class Expressions:
    """Prints the expressions of one law.

    Parameters
    ----------
    program : Printer
    place : Place
    names : dict
        Values of names that are not locals.
    kinds : dict
        Types of locals.
    """

    def __init__(
        self, program: Printer, place: Place, names: dict[str, Any], kinds: dict[str, Type]
    ) -> None:
        self.program, self.place, self.names, self.kinds = program, place, names, kinds

    def print(self, node: ast.expr) -> Value:
        """Print an expression."""
        method = getattr(self, f"_{type(node).__name__.lower()}", None)
        if method is None:
            raise self.refuse(node, f"`{ast.unparse(node)}`", PASS_NUMBERS)
        value: Value = method(node)
        return value

    def refuse(self, node: ast.AST | None, construct: str, remedy: str) -> PrintError:
        """Make the error that names a construct."""
        return self.place.refuse(node, construct, remedy)

    def number(self, node: ast.expr) -> Value:
        """Print an expression that must be a number."""
        value = self.print(node)
        if value.kind not in NUMBERS:
            raise self.refuse(
                node, f"`{ast.unparse(node)}`, no number", "Take a number of it first."
            )
        return value

    def condition(self, node: ast.expr) -> Value:
        """Print an expression that must be true or false."""
        value = self.print(node)
        if value.kind == MASK:
            raise self.refuse(node, f"`{ast.unparse(node)}` of several lanes", ONE_LANE)
        if value.kind != FLAG:
            raise self.refuse(
                node, f"`{ast.unparse(node)}` as a condition", "Write the comparison out, as x > 0."
            )
        return value

    def constant(self, value: Any, node: ast.AST) -> Value:
        """Print a number that the law's module or the law itself states."""
        try:
            return literal(value, self.program.precision)
        except OverflowError:
            raise self.refuse(
                node, f"the constant {value!r}, which single precision cannot hold",
                "Print the law in double precision, or choose a constant from 1.2e-38 to 3.4e38.",
            ) from None  # fmt: skip
        except TypeError:
            raise self.refuse(node, f"a constant {value!r:.60}, no number", PASS_NUMBERS) from None

    def known(self, node: ast.expr) -> Any:
        """Value of a name outside of the law; `inspect.Parameter.empty` for others."""
        if isinstance(node, ast.Name) and node.id not in self.kinds:
            return self.names.get(node.id, inspect.Parameter.empty)
        if isinstance(node, ast.Attribute):
            owner = self.known(node.value)
            if isinstance(owner, python_types.ModuleType):
                return getattr(owner, node.attr, inspect.Parameter.empty)
        return inspect.Parameter.empty

    def _constant(self, node: ast.Constant) -> Value:
        return self.constant(node.value, node)

    def _name(self, node: ast.Name) -> Value:
        if node.id in self.kinds:
            kind = self.kinds[node.id]
            return Value("" if kind == NONE else identifier(node.id), kind)
        value = self.known(node)
        if value is inspect.Parameter.empty:
            raise self.refuse(node, f"the unknown name {node.id}", "Assign it before.")
        return self.constant(value, node)

    def _attribute(self, node: ast.Attribute) -> Value:
        value = self.known(node)
        if value is not inspect.Parameter.empty:
            return self.constant(value, node)
        record = self.print(node.value)
        fields = dict(record.kind.fields) if isinstance(record.kind, Record) else {}
        if node.attr not in fields:
            raise self.refuse(node, f"`{ast.unparse(node)}`, no field", PASS_NUMBERS)
        kind = fields[node.attr]
        return Value("" if kind == NONE else f"{record.code}.{identifier(node.attr)}", kind)

    def _subscript(self, node: ast.Subscript) -> Value:
        value, index = self.print(node.value), self.print(node.slice)
        items = (
            value.kind.items if isinstance(value.kind, Row)
            else value.kind.fields if isinstance(value.kind, Record) else ()
        )  # fmt: skip
        if not items:
            raise self.refuse(node, f"`{ast.unparse(node)}`, no tuple", PASS_NUMBERS)
        if index.kind != INT or index.number is None:
            raise self.refuse(
                node, f"`{ast.unparse(node)}`, an index that varies",
                "Write out the items, as r[0], r[1] and r[2].",
            )  # fmt: skip
        if not -len(items) <= index.number < len(items):
            raise self.refuse(node, f"`{ast.unparse(node)}` of {len(items)} items", "Correct it.")
        return value.item(index.number)

    def _tuple(self, node: ast.Tuple) -> Value:
        if any(isinstance(item, ast.Starred) for item in node.elts):
            raise self.refuse(node, f"`{ast.unparse(node)}`", "Write out the items.")
        items = row([self.print(item) for item in node.elts])
        self.program.add_type(items.kind)
        return items

    def _unaryop(self, node: ast.UnaryOp) -> Value:
        if isinstance(node.op, ast.Not):
            value = self.condition(node.operand)
            number = None if value.number is None else not value.number
            return Value(f"!({value.code})", FLAG, number)
        value = self.number(node.operand)
        if value.kind == FLAG or isinstance(node.op, ast.Invert):
            raise self.refuse(node, f"`{ast.unparse(node)}`", "Use numbers.")
        if isinstance(node.op, ast.UAdd):
            return value
        number = None if value.number is None else -value.number
        return Value(f"(-{value.code})", value.kind, number)

    def _binop(self, node: ast.BinOp) -> Value:
        truth = combined(node.op, self.print(node.left), self.print(node.right))
        if truth is not None:
            return truth
        return self.binary(node.op, self.number(node.left), self.number(node.right), node)

    def binary(self, op: ast.operator, left: Value, right: Value, node: ast.AST) -> Value:
        """Print an operation of two numbers."""
        if isinstance(op, ast.Pow):
            return self._power(left, right, node)
        kind = max(left.kind, right.kind, INT, key=NUMBERS.index)
        if isinstance(op, ast.Div):
            kind = max(kind, REAL, key=NUMBERS.index)
        if kind == LANES and type(op) in ROUNDED_DOWN:
            raise self.refuse(node, f"`{ast.unparse(node)}` of several lanes", ONE_LANE)
        if (type(op) in BITWISE and kind != INT) or isinstance(op, ast.MatMult):
            raise self.refuse(node, f"`{ast.unparse(node)}`", "Shift and mask whole numbers alone.")
        a, b = (converted(value, kind, self.program.precision).code for value in (left, right))
        if type(op) in ROUNDED_DOWN:
            return Value(f"{ROUNDED_DOWN[type(op)]}_{c_name(kind)}({a}, {b})", kind)
        sign = "/" if isinstance(op, ast.Div) else ARITHMETIC.get(type(op)) or BITWISE[type(op)]
        return Value(f"({a} {sign} {b})", kind)

    def _power(self, base: Value, exponent: Value, node: ast.AST) -> Value:
        if exponent.kind == INT:
            if exponent.number is None:
                raise self.refuse(
                    node, f"`{ast.unparse(node)}`, a whole exponent that varies",
                    "Make the exponent a float, or write the products out.",
                )  # fmt: skip
            if base.kind in (FLAG, INT) and exponent.number < 0:
                raise self.refuse(
                    node, f"`{ast.unparse(node)}`, a whole number to a negative power",
                    "Make the number a float.",
                )  # fmt: skip
            kind = max(base.kind, INT, key=NUMBERS.index)
            self.program.add_power(c_name(kind), exponent.number)
            return Value(f"{power_name(c_name(kind), exponent.number)}({base.code})", kind)
        kind = max(base.kind, exponent.kind, REAL, key=NUMBERS.index)
        a, b = (converted(value, kind, self.program.precision).code for value in (base, exponent))
        return Value(f"pow({a}, {b})", kind)

    def _compare(self, node: ast.Compare) -> Value:
        if len(node.ops) == 1 and isinstance(node.ops[0], ast.Is | ast.IsNot):
            return self._is_none(node)
        operands = [self.print(operand) for operand in (node.left, *node.comparators)]
        truth = compared(node.ops, operands, self.program.precision)
        if truth is None:
            raise self.refuse(
                node, f"`{ast.unparse(node)}`", "Compare numbers, all in lanes or none."
            )
        return truth

    def _is_none(self, node: ast.Compare) -> Value:
        right = node.comparators[0]
        if not (isinstance(right, ast.Constant) and right.value is None):
            raise self.refuse(node, f"`{ast.unparse(node)}`", "Compare with == or with None.")
        is_none = self.print(node.left).kind == NONE
        return self.constant(is_none == isinstance(node.ops[0], ast.Is), node)

    def _boolop(self, node: ast.BoolOp) -> Value:
        is_and, parts = isinstance(node.op, ast.And), []
        for operand in node.values:
            value = self.condition(operand)
            if value.number is None:
                parts.append(value.code)
            elif value.number != is_and:  # what comes after it is never looked at
                parts.append(value.code)
                break
        if not parts:
            return self.constant(is_and, node)
        number = (not is_and) if len(parts) == 1 and parts[0] == str(int(not is_and)) else None
        return Value(f"({(' && ' if is_and else ' || ').join(parts)})", FLAG, number)

    def _ifexp(self, node: ast.IfExp) -> Value:
        test = self.print(node.test)
        if test.kind != MASK:
            test = self.condition(node.test)
        if test.number is not None:
            return self.print(node.body if test.number else node.orelse)
        first, second = self.print(node.body), self.print(node.orelse)
        kind = unified(first.kind, second.kind)
        if kind is None or kind == NONE:
            raise self.refuse(node, f"`{ast.unparse(node)}` of two types", "Make them the same.")
        if test.kind == MASK and kind not in NUMBERS:
            raise self.refuse(node, f"`{ast.unparse(node)}` of several lanes", ONE_LANE)
        kind = LANES if test.kind == MASK else kind
        a, b = self.convert(first, kind, node).code, self.convert(second, kind, node).code
        return Value(f"({test.code} ? {a} : {b})", kind)

    def convert(self, value: Value, kind: Type, node: ast.AST) -> Value:
        """Return a value as another type that holds it."""
        try:
            return converted(value, kind, self.program.precision)
        except ValueError:
            raise self.refuse(
                node, "whole numbers in a tuple where others have floats", "Write 0.0 for 0."
            ) from None

    def _call(self, node: ast.Call) -> Value:
        if node.keywords or any(isinstance(argument, ast.Starred) for argument in node.args):
            raise self.refuse(node, f"`{ast.unparse(node)}`", "Pass arguments by position.")
        function = self.known(node.func)
        if function is inspect.Parameter.empty:
            raise self.refuse(node, f"a call of `{ast.unparse(node.func)}`", PASS_NUMBERS)
        arguments = [self.print(argument) for argument in node.args]
        if isinstance(function, type) and hasattr(function, "_fields"):
            return self._record(function, arguments, node)
        if function is len and isinstance(arguments[0].kind, Row | Record):
            kinds = arguments[0].kind
            return self.constant(len(kinds.items if isinstance(kinds, Row) else kinds.fields), node)
        if (
            value := intrinsic(self.place, self.program.precision, function, arguments, node)
        ) is not None:
            return value
        if not isinstance(getattr(function, "py_func", function), python_types.FunctionType):
            raise self.refuse(node, f"a call of `{ast.unparse(node.func)}`", PASS_NUMBERS)
        name, kind = self.program.add(function, *(argument.kind for argument in arguments))
        codes = ", ".join(argument.code for argument in arguments if argument.kind != NONE)
        return Value(f"{name}({codes})", kind)

    def _record(self, function: Any, arguments: list[Value], node: ast.Call) -> Value:
        """Make a named tuple."""
        if len(arguments) != len(function._fields):
            raise self.refuse(node, f"`{ast.unparse(node)}`", "Give it all its fields.")
        kinds = (argument.kind for argument in arguments)
        record = Record(function.__name__, tuple(zip(function._fields, kinds, strict=True)))
        named = self.program.add_type(record)
        assert isinstance(named, Record)
        return Value(struct_of(named, arguments), named)
