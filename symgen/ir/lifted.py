"""Kernels read back, statement by statement: what writes, changes or orders statements is held to be an identity.

As for scalars, values in the field of fingerprints are compared first, and exactly where those differ.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import lru_cache
from typing import Generic, TypeAlias, TypeVar

from symgen.diagnostics import SymgenBug
from symgen.ir.kernel import Block, Check, Kernel, Literal, Load, Local, Operand, Statement, Status
from symgen.ir.last_kernels import LastKernels
from symgen.ir.pairs.wide_functions import is_wide, plain_operation
from symgen.records import dataclass
from symgen.symbolic.fingerprint import PRIME, angle_pair, combine, leaf_pair, opaque, residue
from symgen.symbolic.graph import Graph
from symgen.symbolic.identity import same_values
from symgen.symbolic.scalar import Scalar as Node
from symgen.symbolic.traverse import topological

# A scalar of a graph, or its value in the field of fingerprints.
Value = TypeVar("Value")
# A status, whether it is inclusive, and how many failed checks it stands behind.
Kind: TypeAlias = tuple[Status, bool, int]


@dataclass(frozen=True, slots=True)
class Meant(Generic[Value]):
    """The outputs of a kernel; the checks in their order, without those of the range of angles, value and limit."""

    outputs: tuple[Value, ...]
    kinds: tuple[Kind, ...]
    compared: tuple[Value, ...]


@dataclass(frozen=True, slots=True)
class Lifted:
    """A kernel to be read back; where it is prepared, `statements` assign what it loads as parameters from `loads`.

    A load of index k takes the local `prepared[k]`.
    """

    kernel: Kernel
    loads: tuple[Load, ...] = ()
    statements: tuple[Statement, ...] = ()
    prepared: tuple[Local, ...] = ()


def same_kernel(
    rule: str, before: Lifted | Meant[Node], after: Lifted, whole: bool = True, squares_roots: bool = False
) -> None:
    """Raises SymgenBug where outputs or checks of a kernel are not what they were.

    Unless they are compared `whole`, checks that tell one failure from another may have gone.  `squares_roots` as for
    `same_values`.
    """
    quick = _residues(before) if isinstance(before, Lifted) else _values(before)
    quick = quick if whole else _plain(quick)
    quick_after = _residues(after)
    if quick == quick_after:
        return
    meant = _NodeReader().meant(before) if isinstance(before, Lifted) else before
    meant, exact = meant if whole else _plain(meant), _NodeReader().meant(after)
    if meant.kinds != exact.kinds:
        raise SymgenBug(f"{rule}: changes the checks of a kernel")
    same_values(rule, [*meant.outputs, *meant.compared], [*exact.outputs, *exact.compared], squares_roots)


def _residues(lifted: Lifted) -> Meant[int]:
    """What a kernel computes and tests; several passes begin with one kernel."""
    if lifted.prepared:
        return _ResidueReader().meant(lifted)
    return _READ.of(lifted.kernel, lambda: _ResidueReader().meant(lifted))


_READ = LastKernels[Meant[int]](8)


def _values(meant: Meant[Node]) -> Meant[int]:
    """Fingerprints as statements have them, where nothing keeps a value that is rounded apart from what it was."""
    members = [*meant.outputs, *meant.compared]
    order = topological(members)
    if any(node.op == "rounded" for node in order):
        members = _as_they_stand(members, order)
    values, count = [node.value for node in members], len(meant.outputs)
    return Meant(tuple(values[:count]), meant.kinds, tuple(values[count:]))


def _as_they_stand(outputs: Sequence[Node], order: Sequence[Node]) -> list[Node]:
    """The outputs on a graph of their own, without roundings: angles are read by what stood under these, too."""
    graph = Graph()
    image: dict[Node, Node] = {}
    for node in order:
        if node.op == "rounded":
            image[node] = image[node.args[0]]
        elif node.constant is not None:
            image[node] = graph.const(node.constant)
        elif node.op == "symbol":
            image[node] = graph.symbol(str(node.payload))
        else:
            image[node] = graph.raw(node.op, tuple(image[a] for a in node.args), node.payload)
    return [image[output] for output in outputs]


def _plain(meant: Meant[Value]) -> Meant[Value]:
    kept = [k for k, (_, _, depth) in enumerate(meant.kinds) if not depth]
    compared = tuple(x for k in kept for x in meant.compared[2 * k : 2 * k + 2])
    return Meant(meant.outputs, tuple(meant.kinds[k] for k in kept), compared)


class _StatementReader(Generic[Value]):
    """Values of locals, as they are assigned."""

    def __init__(self) -> None:
        self._known: dict[str, Value] = {}

    def _number(self, value: Fraction) -> Value:
        raise NotImplementedError

    def _symbol(self, name: str) -> Value:
        raise NotImplementedError

    def _pair(self, angle: Value) -> tuple[Value, Value]:
        """Sine and cosine."""
        raise NotImplementedError

    def _write(self, statements: Sequence[Statement]) -> None:
        """The targets of statements."""
        raise NotImplementedError

    def meant(self, lifted: Lifted) -> Meant[Value]:
        """What a kernel computes and tests."""
        loads = lifted.kernel.loads
        if lifted.prepared:
            self._known = {load.local: self._symbol(load.local) for load in lifted.loads}
            self._write(lifted.statements)
            given = [self._known[local.name] for local in lifted.prepared]
            self._known = {load.local: given[load.index] for load in loads if load.argument == "p"}
        for load in loads:
            if load.local not in self._known:
                self._known[load.local] = self._loaded(load)
        tests = [test for block in lifted.kernel.blocks for test in self._block(block, 0)]
        outputs = tuple(map(self._operand, lifted.kernel.outputs))
        return Meant(outputs, tuple(kind for kind, _, _ in tests), tuple(x for _, *pair in tests for x in pair))

    def _loaded(self, load: Load) -> Value:
        if load.argument != "sc":
            return self._symbol(load.local)
        half, _, name = load.member.partition("_")
        return self._pair(self._symbol(name))[half == "cos"]

    def _operand(self, operand: Operand) -> Value:
        if isinstance(operand, Literal):
            return self._number(operand.value)
        value = self._known.get(operand.name)
        if value is None:
            # thresholds, which have a blank in their names, wait for the scalar type
            if " " not in operand.name:
                raise SymgenBug(f"kernel: {operand.name} is read, and nothing has assigned it")
            value = self._known[operand.name] = self._symbol(operand.name)
        return value

    def _block(self, block: Block, depth: int) -> list[tuple[Kind, Value, Value]]:
        """The tests of a block in their order."""
        self._write(block.statements)
        return [test for check in block.checks for test in self._check(check, depth)]

    def _check(self, check: Check, depth: int) -> list[tuple[Kind, Value, Value]]:
        compared: list[tuple[Kind, Value, Value]] = []
        if check.status is not Status.ANGLE_RANGE:
            kind = check.status, check.inclusive, depth
            compared.append((kind, self._operand(check.value), self._operand(check.limit)))
        if check.first is not None:
            saved = dict(self._known)
            compared += self._block(check.first, depth + 1)
            self._known = saved
        return compared


class _NodeReader(_StatementReader[Node]):
    """Scalars on a graph of their own, as they stand."""

    def __init__(self) -> None:
        super().__init__()
        self._graph = Graph()

    def _number(self, value: Fraction) -> Node:
        return self._graph.const(value)

    def _symbol(self, name: str) -> Node:
        return self._graph.symbol(name)

    def _pair(self, angle: Node) -> tuple[Node, Node]:
        return self._graph.raw("sin", (angle,)), self._graph.raw("cos", (angle,))

    def _write(self, statements: Sequence[Statement]) -> None:
        for statement in statements:
            operation, operands = statement.operation, tuple(map(self._operand, statement.operands))
            if is_wide(statement):
                operation, operands = plain_operation(operation), tuple(map(self._sum, operands[::2], operands[1::2]))
                self._known[statement.targets[1]] = self._graph.zero
            if operation == "sincos":
                self._known |= zip(statement.targets, self._pair(operands[0]), strict=True)
            elif operation == "pow":
                self._known[statement.targets[0]] = self._graph.raw("pow", operands[:1], operands[1].constant)
            else:
                self._known[statement.targets[0]] = self._graph.raw(operation, operands)


    def _sum(self, value: Node, rest: Node) -> Node:
        """Of a pair, as it stands."""
        return value if rest.is_zero else self._graph.raw("add", (value, rest))


class _ResidueReader(_StatementReader[int]):
    """Fingerprints; angles are read by what their sums were made of."""

    def __init__(self) -> None:
        super().__init__()
        # by values: when a sum was made, of which parts, and how often they count
        self._sums: dict[int, tuple[int, tuple[tuple[int, int], ...]]] = {}

    def _number(self, value: Fraction) -> int:
        return _residue(value)

    def _symbol(self, name: str) -> int:
        return _symbol_residue(name)

    def _pair(self, angle: int) -> tuple[int, int]:
        cosine, sine = _turned(tuple(self._form(angle).items()))
        return sine, cosine

    def _form(self, angle: int) -> dict[int, int]:
        form: dict[int, int] = {}
        stack = [(angle, 1, len(self._sums))]
        while stack:
            value, count, before = stack.pop()
            made, parts = self._sums.get(value, (before, ()))
            if made < before:
                # values may be made again later of what was made of them
                stack += [(part, count * times, made) for part, times in parts]
            elif value:
                form[value] = form.get(value, 0) + count
        return {value: count for value, count in form.items() if count}

    def _write(self, statements: Sequence[Statement]) -> None:
        known, sums = self._known, self._sums
        for statement in statements:
            operation, operands = statement.operation, statement.operands
            values = [
                known[o.name] if isinstance(o, Local) and o.name in known else self._operand(o) for o in operands
            ]
            if is_wide(statement):
                operation, values = plain_operation(operation), [*map(self._sum, values[::2], values[1::2])]
                operands = operands[::2]
                known[statement.targets[1]] = 0
            if operation == "mul":
                a, b = values
                value = a * b % PRIME
                first = operands[0]
                if isinstance(first, Literal) and first.value.denominator == 1:
                    sums.setdefault(value, (len(sums), ((b, first.value.numerator),)))
            elif operation == "add":
                a, b = values
                value = (a + b) % PRIME
                sums.setdefault(value, (len(sums), ((a, 1), (b, 1))))
            elif operation == "sub":
                a, b = values
                value = (a - b) % PRIME
                sums.setdefault(value, (len(sums), ((a, 1), (b, -1))))
            elif operation == "sincos":
                known |= zip(statement.targets, self._pair(values[0]), strict=True)
                continue
            elif operation == "pow":
                value = combine(operation, values[:1], _exponent(operands[1]))
            else:
                value = combine(operation, values, None)
                if operation == "neg":
                    sums.setdefault(value, (len(sums), ((values[0], -1),)))
            known[statement.targets[0]] = value


    def _sum(self, value: int, rest: int) -> int:
        """Of a pair, read as what the value was made of where nothing is added."""
        return value if not rest else (value + rest) % PRIME


def _exponent(operand: Operand) -> Fraction:
    assert isinstance(operand, Literal)
    return operand.value


@lru_cache(maxsize=4096)
def _residue(value: Fraction) -> int:
    return residue(value)


@lru_cache(maxsize=4096)
def _symbol_residue(name: str) -> int:
    return opaque("symbol", name)


@lru_cache(maxsize=1024)
def _leaf(value: int) -> tuple[int, int]:
    return leaf_pair(value)


@lru_cache(maxsize=1024)
def _turned(form: tuple[tuple[int, int], ...]) -> tuple[int, int]:
    return angle_pair(dict(form), {value: _leaf(value) for value, _ in form})
