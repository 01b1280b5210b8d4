"""Statements of a law in OpenCL C: assignments, branches, short loops and returned values."""

import ast

from quintet.components.shared.opencl.expressions import Expressions
from quintet.components.shared.opencl.names import identifier
from quintet.components.shared.opencl.types import INT, NONE, Record, Row, Type, unified
from quintet.components.shared.opencl.values import Value

INDENT = "    "


class Statements:
    """Prints the body of one law, once its types are known.

    The types of locals and of the returned value are found by printing: it is repeated until they
    stay as they are.
    """

    def __init__(self, expressions: Expressions, parameters: set[str]) -> None:
        self.expressions, self.parameters = expressions, parameters
        self.kinds, self.refuse = expressions.kinds, expressions.refuse
        self.returned: Type | None = None
        self.temporaries = 0
        self.lines: list[str] = []

    def print(self, body: list[ast.stmt]) -> list[str]:
        """Print the body of a function."""
        while True:
            previous, self.lines, self.temporaries = (dict(self.kinds), self.returned), [], 0
            if not self._block(body, 1):
                raise self.refuse(
                    body[-1], "a way to its end without a value", "Return a value at the end."
                )
            if previous == (self.kinds, self.returned):
                return self.lines

    def _write(self, line: str, depth: int) -> None:
        self.lines.append(INDENT * depth + line)

    def _block(self, body: list[ast.stmt], depth: int) -> bool:
        """Print statements; tell whether all ways through them return."""
        for statement in body:
            if self._statement(statement, depth):
                return True
        return False

    def _statement(self, node: ast.stmt, depth: int) -> bool:
        match node:
            case ast.Expr(value=ast.Constant(value=str())) | ast.Pass():
                return False
            case ast.Assign(targets=[target], value=value):
                self._assign(target, value, node, depth)
            case ast.AnnAssign(target=target, value=ast.expr() as value):
                self._assign(target, value, node, depth)
            case ast.AugAssign(target=ast.Name() as target, op=op, value=value):
                read = ast.copy_location(ast.Name(target.id, ast.Load()), target)
                operation = ast.copy_location(ast.BinOp(read, op, value), node)
                self._assign(target, operation, node, depth)
            case ast.Return(value=ast.expr() as value):
                self._return(value, node, depth)
                return True
            case ast.If():
                return self._if(node, depth)
            case ast.For():
                self._for(node, depth)
            case ast.Break():
                self._write("break;", depth)
            case _:
                text = ast.unparse(node).splitlines()[0]
                raise self.refuse(
                    node, f"`{text}`",
                    "Assign to locals, and use if, for over range and return; arrays, exceptions "
                    "and other loops belong in the kernel.",
                )  # fmt: skip
        return False

    def _return(self, expression: ast.expr, node: ast.stmt, depth: int) -> None:
        value = self.expressions.print(expression)
        kind = value.kind if self.returned is None else unified(self.returned, value.kind)
        if kind is None or kind == NONE:
            raise self.refuse(
                node, f"`{ast.unparse(node)}` where it returns another type elsewhere",
                "Return the same number of numbers everywhere.",
            )  # fmt: skip
        self.returned = self.expressions.program.add_type(kind)
        value = self.expressions.convert(value, self.returned, node)
        self._write(f"return {_bare(value.code)};", depth)

    def _if(self, node: ast.If, depth: int) -> bool:
        test = self.expressions.condition(node.test)
        if test.number is not None:
            return self._block(node.body if test.number else node.orelse, depth)
        self._write(f"if ({_bare(test.code)}) {{", depth)
        ends = self._block(node.body, depth + 1)
        if node.orelse:
            self._write("} else {", depth)
            ends = self._block(node.orelse, depth + 1) and ends
        self._write("}", depth)
        return ends and bool(node.orelse)

    def _for(self, node: ast.For, depth: int) -> None:
        remedy = "Write `for name in range(number)`, the number known as the law is printed."
        text = f"`for {ast.unparse(node.target)} in {ast.unparse(node.iter)}`"
        call, target = node.iter, node.target
        is_range = isinstance(call, ast.Call) and isinstance(call.func, ast.Name)
        if not (is_range and isinstance(target, ast.Name)) or node.orelse:
            raise self.refuse(node, text, remedy)
        assert isinstance(call, ast.Call)
        bounds = [self.expressions.print(bound) for bound in call.args]
        is_known = all(bound.kind == INT and bound.number is not None for bound in bounds)
        if self.expressions.known(call.func) is not range or not is_known or call.keywords:
            raise self.refuse(node, text, remedy)
        numbers = range(*(bound.number for bound in bounds))
        self._declare(target, INT, node)
        name = identifier(target.id)
        sign = "<" if numbers.step > 0 else ">"
        head = (
            f"{name} = {numbers.start}L; {name} {sign} {numbers.stop}L; {name} += {numbers.step}L"
        )
        self._write(f"for ({head}) {{", depth)
        self._block(node.body, depth + 1)
        self._write("}", depth)

    def _assign(self, target: ast.expr, value: ast.expr, node: ast.stmt, depth: int) -> None:
        printed = self.expressions.print(value)
        if isinstance(target, ast.Tuple) and printed.items is not None:
            # Values that name targets are kept before these change.
            names = {name.id for name in ast.walk(target) if isinstance(name, ast.Name)}
            read = {name.id for name in ast.walk(value) if isinstance(name, ast.Name)}
            if names & read:
                printed = self._in_temporaries(printed, depth)
        elif isinstance(target, ast.Tuple) and not printed.code.isidentifier():
            printed = Value(self._temporary(printed, depth), printed.kind)
        self._store(target, printed, node, depth)

    def _in_temporaries(self, value: Value, depth: int) -> Value:
        """Return the value, its numbers in new variables."""
        if value.items is None:
            if value.number is not None or value.kind == NONE:
                return value
            return Value(self._temporary(value, depth), value.kind)
        return Value(
            "", value.kind, items=tuple(self._in_temporaries(item, depth) for item in value.items)
        )

    def _temporary(self, value: Value, depth: int) -> str:
        self.temporaries += 1
        name = f"value_{self.temporaries}"
        self._write(f"const {value.kind.name} {name} = {_bare(value.code)};", depth)
        return name

    def _store(self, target: ast.expr, value: Value, node: ast.stmt, depth: int) -> None:
        """Store a value under a name, or its items under several."""
        if isinstance(target, ast.Tuple):
            kind = value.kind
            count = len(kind.items) if isinstance(kind, Row) else 0
            count = len(kind.fields) if isinstance(kind, Record) else count
            if count != len(target.elts):
                raise self.refuse(
                    node, f"{count} values for {len(target.elts)} names", "Name each of them."
                )
            for number, element in enumerate(target.elts):
                self._store(element, value.item(number), node, depth)
            return
        if not isinstance(target, ast.Name):
            raise self.refuse(
                node, f"a value stored in `{ast.unparse(target)}`",
                "Return it, and store it in the kernel.",
            )  # fmt: skip
        kind = self._declare(target, value.kind, node)
        if kind != NONE:
            code = self.expressions.convert(value, kind, node).code
            self._write(f"{identifier(target.id)} = {_bare(code)};", depth)

    def _declare(self, target: ast.Name, kind: Type, node: ast.stmt) -> Type:
        """Note the type of a local."""
        previous = self.kinds.get(target.id)
        common = kind if previous is None else unified(previous, kind)
        if common is None or (target.id in self.parameters and common != previous):
            raise self.refuse(
                node, f"{target.id}, which changes its type", "Give the second value its own name."
            )
        self.kinds[target.id] = common
        return common


def locals_of(kinds: dict[str, Type], parameters: set[str]) -> list[str]:
    """Declarations of locals, those of a type in one line."""
    by_type: dict[str, list[str]] = {}
    for name, kind in kinds.items():
        if name not in parameters and kind != NONE:
            by_type.setdefault(kind.name, []).append(identifier(name))
    return [f"{INDENT}{kind} {', '.join(names)};" for kind, names in by_type.items()]


def _bare(code: str) -> str:
    """Code without parentheses around all of it."""
    if not (code.startswith("(") and code.endswith(")")):
        return code
    depth = 0
    for place, letter in enumerate(code):
        depth += (letter == "(") - (letter == ")")
        if depth == 0 and place < len(code) - 1:
            return code
    return code if code.startswith(("((tuple", "((")) and "){" in code else code[1:-1]
