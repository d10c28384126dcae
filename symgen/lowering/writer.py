"""Statements of scalars: each operation once per kernel, operands before the operation that needs them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction

from symgen.diagnostics import SymgenBug
from symgen.ir.kernel import Block, Check, Literal, Load, Local, Operand, Statement, Status
from symgen.mechanics.system import System
from symgen.model.quantities import Argument
from symgen.records import dataclass
from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar as Node
from symgen.symbolic.traverse import topological

# Stands for the range of the sine and cosine until the scalar type is known; no name of a model has a blank.
ANGLE = "angle limit"


@dataclass(frozen=True, slots=True)
class Test:
    """A guard with its limit as a scalar: passes where denominator > limit (or < -limit, hence `size`).

    `vanishes`: where it fails, the terms of `size` are 0 to rounding.
    """

    status: Status
    size: Node
    limit: Node
    first: tuple[Test, ...]
    vanishes: bool


def angles_of(outputs: Sequence[Node]) -> list[Node]:
    """The arguments of sines and cosines that the outputs need, each once."""
    return angles_among(topological(outputs))


def angles_among(nodes: Sequence[Node]) -> list[Node]:
    """The arguments of sines and cosines among the nodes, each once, in their order."""
    return list(dict.fromkeys(node.args[0] for node in nodes if node.op in ("sin", "cos")))


class ScalarWriter:
    """Turns scalars into statements, each once per kernel."""

    def __init__(self, mechanics: System, arguments: Sequence[str], apart: bool) -> None:
        self._graph: Graph = mechanics.graph
        self._arguments = arguments
        self._apart = apart
        self._written: dict[Node, Operand] = {}
        self._pairs: dict[Node, tuple[str, str]] = {}
        self._done: dict[tuple[str, tuple[Operand, ...]], Local] = {}
        self._loads: dict[str, Load] = {}
        self._tested: set[Node] = set()
        self._symbols = _symbol_loads(mechanics)
        self._labels = {node: name for name, node in mechanics.definitions.items()}
        taken = set(self._symbols) | set(mechanics.definitions)
        self._taken = taken
        self._count = 0

    def loads(self) -> tuple[Load, ...]:
        """The inputs used, arguments first, each in order of its index."""
        # those of the model, argument by argument
        order = {name: k for k, name in enumerate(self._symbols)}
        return tuple(sorted(self._loads.values(), key=lambda load: order[load.local]))

    def operand(self, node: Node) -> Operand:
        """The operand of a node that has been written, or of a constant or an input."""
        if (value := node.constant) is not None:
            return Literal(value)
        if node.op == "symbol" and node not in self._written:
            load = self._symbols.get(str(node.payload))
            if load is None:
                # a threshold, whose number is filled in for each scalar type
                return Local(str(node.payload))
            if load.argument != "p" and load.argument not in self._arguments:
                raise SymgenBug(f"schedule: {node.payload} is not an argument of this kernel")
            self._loads[load.local] = load
            return Local(load.local)
        return self._written[node]

    def angle_block(self, arguments: Sequence[Node]) -> Block:
        """The arguments of sines and cosines that need no other sine or cosine, and the tests of their range."""
        statements = self.write(arguments)
        tests, checks = self.range_checks(arguments)
        return Block((*statements, *tests), checks)

    def pairs(self, arguments: Sequence[Node], order: Sequence[Node]) -> list[Statement]:
        """The sine/cosine pairs of known arguments among nodes: calls come first, while few values are alive."""
        known = set(arguments)
        return self.write([n for n in order if n.op in ("sin", "cos") and n.args[0] in known])

    def range_checks(self, arguments: Sequence[Node]) -> tuple[tuple[Statement, ...], tuple[Check, ...]]:
        """The tests of the range of angles."""
        sizes = [self._graph.raw("abs", (argument,)) for argument in arguments]
        statements = self.write(sizes)
        checks = tuple(Check(Status.ANGLE_RANGE, Local(ANGLE), self.operand(size), inclusive=True) for size in sizes)
        return tuple(statements), checks

    def late_angles(self, outputs: Sequence[Node], computed: Sequence[Node]) -> list[Block]:
        """The blocks of those `computed` arguments that the outputs need and that no earlier block has tested."""
        needed = set(angles_of(outputs)) if computed else ()
        blocks = []
        for argument in computed:
            if argument in needed and argument not in self._tested:
                self._tested.add(argument)
                tests, checks = self.range_checks([argument])
                blocks.append(Block(tests, checks))
        return blocks

    def check(self, test: Test, image: Mapping[Node, Node]) -> Check:
        """The check of a test; what only a failure needs is written into its own block."""
        first = None
        if test.first:
            saved = dict(self._written), dict(self._pairs), dict(self._done), self._labels
            apart, self._apart = self._apart, False
            if apart:
                self._written = {n: value for n, value in self._written.items() if n.op in ("sin", "cos")}
                self._done, self._labels = {}, {}
            inner = [image[node] for t in test.first for node in (t.size, t.limit)]
            angles = [angle for angle in angles_of(inner) if angle not in self._pairs]
            statements = self.write(inner)
            sizes, ranges = self.range_checks(angles)
            first = Block((*statements, *sizes), (*ranges, *(self.check(t, image) for t in test.first)))
            self._written, self._pairs, self._done, self._labels = saved
            self._apart = apart
        size, limit = self.operand(image[test.size]), self.operand(image[test.limit])
        return Check(test.status, size, limit, first=first, apart=self._apart and first is not None)

    def write(self, outputs: Sequence[Node]) -> list[Statement]:
        """The statements that are still missing for the outputs."""
        statements: list[Statement] = []
        for node in topological(outputs, self._written):
            if node in self._written or node.op in ("const", "symbol"):
                # a pair writes both its values, so the second one may be known by now
                continue
            if node.op in ("sin", "cos"):
                statements += self._pair(node)
            else:
                statements += self._plain(node)
        for output in outputs:
            self.operand(output)
        return statements

    def _plain(self, node: Node) -> list[Statement]:
        """The node's statement, or none where the same operation on the same operands stands already."""
        operands = tuple(self.operand(argument) for argument in node.args)
        if node.op == "rounded":
            # no operation: what has been computed is a number
            (self._written[node],) = operands
            return []
        if node.op == "pow":
            assert isinstance(node.payload, Fraction)
            operands = (*operands, Literal(node.payload))
        done = self._done.get((node.op, operands))
        if done is not None:
            self._written[node] = done
            return []
        target = self._name(node)
        self._written[node] = self._done[node.op, operands] = Local(target)
        return [Statement((target,), node.op, operands)]  # type: ignore[arg-type]

    def _pair(self, node: Node) -> list[Statement]:
        """The sine/cosine pair of an angle, once; its other value needs no statement."""
        (angle,) = node.args
        known = self._pairs.get(angle)
        if known is None:
            sine, cosine = (self._graph.trig(op, angle) for op in ("sin", "cos"))
            known = self._pairs[angle] = self._name(sine), self._name(cosine)
            self._written[node] = Local(known[node.op == "cos"])
            return [Statement(known, "sincos", (self.operand(angle),))]
        self._written[node] = Local(known[node.op == "cos"])
        return []

    def _name(self, node: Node) -> str:
        if (label := self._labels.get(node)) is not None:
            return label
        return self._fresh()

    def _fresh(self) -> str:
        while True:
            self._count += 1
            name = f"t{self._count}"
            if name not in self._taken:
                return name


def _symbol_loads(mechanics: System) -> dict[str, Load]:
    """By name, in the order of signatures."""
    model = mechanics.model
    arrays: tuple[tuple[Argument, Iterable[str]], ...] = (
        ("q", (c.name for c in model.coordinates)),
        ("qd", (c.rate for c in model.coordinates)),
        ("qdd", (c.acceleration for c in model.coordinates)),
        ("u", (given.name for given in model.inputs)),
    )
    loads = {name: Load(name, argument, i) for argument, names in arrays for i, name in enumerate(names)}
    for further in model.further_arguments:
        for i, (name, place) in enumerate(zip(further.names, further.places, strict=True)):
            loads[name] = Load(name, further.name, i, place=place)
    for i, parameter in enumerate(model.parameters):
        loads[parameter.name] = Load(parameter.name, "p", i, parameter.name)
    return loads
