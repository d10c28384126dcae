"""Hash-consed real scalars: the graph every kernel is derived on.

Each distinct operation exists once, so equal intermediates are shared where they arise and nothing is expanded to be
shrunk again.  All rewriting happens in the constructors, each rule local and exact: constants fold, signs travel
outwards, x - x and x*y/y cancel, sums are never flattened, and products of sines and cosines of the same angles
combine by the addition theorem.  The graph knows no mechanics.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Set
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

from symgen.runtime.effort import SCALAR, spend
from symgen.symbolic.angles.angle_forms import Angles
from symgen.symbolic.fingerprint import FAMILIES, PRIME, combine, family, opaque, residue
from symgen.symbolic.functions import expanded, simplified
from symgen.symbolic.products import Products
from symgen.symbolic.scalar import Number, Scalar

if TYPE_CHECKING:
    from symgen.symbolic.exact import ExactValues


class Mark(NamedTuple):
    """How many scalars, keys of scalars and products taken apart there are."""

    scalars: int
    keys: int
    products: int


# That of a graph that nothing is made on yet.
START = Mark(0, 0, 0)


class Graph:
    """Creates and owns scalars; `serial` numbers give a deterministic order of operands."""

    def __init__(self) -> None:
        self._nodes: dict[tuple[object, ...], Scalar] = {}
        # by numerator and denominator, whose hash costs a fraction of a Fraction's
        self._constants: dict[tuple[int, int], Scalar] = {}
        # every scalar at the place of its serial number, None where it is forgotten
        self._serials: list[Scalar | None] = []
        self.products = Products(self)
        # by seeds: values of the scalars at points, as far as they have been needed
        self.points: dict[int, ExactValues] = {}
        self._by_value: dict[int, Scalar] = {}
        self._stand_ins = 0
        self._angles = Angles(self)
        self.zero = self.const(0)
        self.one = self.const(1)
        self.const(2)

    def __len__(self) -> int:
        return len(self._nodes)

    def _node(self, op: str, args: tuple[Scalar, ...], payload: object = None) -> Scalar:
        """The node, or a shorter one that is the same function."""
        key = (op, args, payload)
        node = self._nodes.get(key)
        if node is None:
            node = self._new(key, op, args, payload)
            same = self._by_value.get(node.value)
            # stand-ins that cancel in an equal function must not come in: they would outlast their replacement
            foreign = ~node.stands
            if same is not None and same.size <= node.size and not same.stands & foreign:
                node = same
            elif (
                op != "neg"
                and (opposite := self._by_value.get(-node.value % PRIME))
                and opposite.size < node.size
                and not opposite.stands & foreign
            ):
                node = self.neg(opposite)
            else:
                self._by_value[node.value] = node
            self._nodes[key] = node
        return node

    def _new(self, key: tuple[object, ...], op: str, args: tuple[Scalar, ...], payload: object) -> Scalar:
        spend(SCALAR)
        node = self._nodes[key] = Scalar(self, len(self._serials), op, args, payload)
        self._serials.append(node)
        if op == "mul":
            node.value = args[0].value * args[1].value % PRIME
            node.family = args[0].family * args[1].family % FAMILIES
            return node
        if op == "add":
            node.value = (args[0].value + args[1].value) % PRIME
        elif op == "const":
            assert isinstance(payload, Fraction)
            node.value = residue(payload)
        elif op == "symbol":
            node.value = opaque("symbol", payload)
        elif op in ("sin", "cos"):
            node.value = self._angles.residues(args[0])[op == "sin"]
        elif len(args) == 2:
            node.value = combine(op, (args[0].value, args[1].value), payload)
        else:
            node.value = combine(op, [a.value for a in args], payload)
        node.family = family(op, node.value, [a.family for a in args])
        return node

    def at(self, serial: int) -> Scalar:
        """The scalar with a serial number."""
        node = self._serials[serial]
        assert node is not None, "a scalar that is in use was forgotten"
        return node

    def mark(self) -> Mark:
        """Where stands what is made from now on."""
        return Mark(len(self._serials), len(self._nodes), len(self.products))

    def forget(self, mark: Mark, stays: Callable[[Scalar], bool]) -> Set[Scalar]:
        """Lets go of the scalars since the mark that do not stay, and tells which these were.

        See `symgen.symbolic.passes.forgetting`.
        """
        gone = {node for node in self._serials[mark.scalars :] if node is not None and not stays(node)}
        kept = []
        # keys stand in the order in which they were made, and hold operands, too
        while len(self._nodes) > mark.keys:
            key, node = self._nodes.popitem()
            args = key[2] if key[0] == "raw" else key[1]
            assert isinstance(args, tuple)
            if node not in gone and gone.isdisjoint(args):
                kept.append((key, node))
        self._nodes.update(reversed(kept))
        self._angles.forget(gone)
        self.points.clear()
        self.products.forget(mark.products, gone)
        for node in gone:
            self._serials[node.serial] = None
            if self._by_value.get(node.value) is node:
                del self._by_value[node.value]
        return gone

    def dissolve(self) -> None:
        """Lets go of all scalars but those that somebody holds; nothing is made on this graph any more.

        A graph and its scalars hold each other: nobody else would let go of what derivations leave behind.
        """
        for known in (self._nodes, self._constants, self._serials, self._by_value):
            known.clear()
        self.points.clear()
        self._angles, self.products = Angles(self), Products(self)

    def lift(self, value: Number) -> Scalar:
        """A scalar of this graph from a scalar, an integer or a rational number."""
        return value if isinstance(value, Scalar) else self.const(value)

    def const(self, value: int | Fraction) -> Scalar:
        """An exact constant."""
        key = value.numerator, value.denominator
        node = self._constants.get(key)
        if node is None:
            node = self._constants[key] = self._node("const", (), Fraction(value))
        return node

    def symbol(self, name: str) -> Scalar:
        """A named input."""
        return self._node("symbol", (), name)

    def stand_in(self, name: str) -> Scalar:
        """A symbol that something else replaces later; nothing that is made without it ever holds it."""
        node = self.symbol(name)
        if not node.stands:
            self._stand_ins += 1
            node.stands = 1 << self._stand_ins
        return node

    def raw(self, op: str, args: tuple[Scalar, ...], payload: object = None) -> Scalar:
        """The operation as it stands, past the constructor rules."""
        if op in ("add", "mul") and args[0].constant is None:
            # the order of the constructors: numbers first, then by serial
            args = args if args[1].constant is None and args[0].serial < args[1].serial else args[::-1]
        usual = self._nodes.get((op, args, payload))
        if usual is not None and usual.op == op and usual.args == args:
            return usual
        key = ("raw", op, args, payload)
        node = self._nodes.get(key)
        return self._new(key, op, args, payload) if node is None else node

    def beside(self, op: str, args: tuple[Scalar, ...], payload: object = None) -> Scalar:
        """The operation as it stands, unknown to the graph: what it is compared with is made in the same order."""
        node = Scalar(self, len(self._serials), op, args, payload)
        values = [a.value for a in args]
        node.value = combine(op, values, payload) if node.constant is None else residue(node.constant)
        return node

    def sum(self, terms: Iterable[Scalar]) -> Scalar:
        """Left-to-right sum; 0 for no terms."""
        total = self.zero
        for term in terms:
            total = self.add(total, term)
        return total

    def product(self, factors: Iterable[Scalar]) -> Scalar:
        """Left-to-right product; 1 for no factors."""
        total = self.one
        for factor in factors:
            total = self.mul(total, factor)
        return total

    def neg(self, a: Scalar) -> Scalar:
        """-a."""
        if a.op == "neg":
            return a.args[0]
        if (value := a.constant) is not None:
            return self.const(-value)
        if a.op == "sub":
            return self._node("sub", (a.args[1], a.args[0]))
        return self._node("neg", (a,))

    def add(self, a: Scalar, b: Scalar) -> Scalar:
        """a + b."""
        if a.is_zero:
            return b
        if b.is_zero:
            return a
        if b.op == "neg":
            return self.sub(a, b.args[0])
        if a.op == "neg":
            return self.sub(b, a.args[0])
        if a.constant is not None and b.constant is not None:
            return self.const(a.constant + b.constant)
        if a is b:
            return self.mul(self.const(2), a)
        if a.op == "sub" and a.args[1] is b:
            return a.args[0]
        if b.op == "sub" and b.args[1] is a:
            return b.args[0]
        if (combined := self.products.combined(a, b, 1)) is not None:
            return combined
        if a.serial > b.serial:
            a, b = b, a
        return self._node("add", (a, b))

    def sub(self, a: Scalar, b: Scalar) -> Scalar:
        """a - b."""
        if a is b:
            return self.zero
        if b.is_zero:
            return a
        if a.is_zero:
            return self.neg(b)
        if b.op == "neg":
            return self.add(a, b.args[0])
        if a.op == "neg":
            return self.neg(self.add(a.args[0], b))
        if a.constant is not None and b.constant is not None:
            return self.const(a.constant - b.constant)
        if a.op == "add" and b in a.args:
            return a.args[1] if a.args[0] is b else a.args[0]
        if a.op == "sub" and a.args[0] is b:
            return self.neg(a.args[1])
        if b.op == "add" and a in b.args:
            return self.neg(b.args[1] if b.args[0] is a else b.args[0])
        if b.op == "sub" and b.args[0] is a:
            return b.args[1]
        if (combined := self.products.combined(a, b, -1)) is not None:
            return combined
        return self._node("sub", (a, b))

    def mul(self, a: Scalar, b: Scalar) -> Scalar:
        """a * b."""
        if a.is_zero or b.is_zero:
            return self.zero
        if a.is_one:
            return b
        if b.is_one:
            return a
        if a.op == "neg":
            return self.neg(self.mul(a.args[0], b))
        if b.op == "neg":
            return self.neg(self.mul(a, b.args[0]))
        if a.constant is None and b.constant is not None:
            a, b = b, a
        if (value := a.constant) is not None:
            if b.constant is not None:
                return self.const(value * b.constant)
            if value < 0:
                return self.neg(self.mul(self.const(-value), b))
            if b.op == "mul" and (inner := b.args[0].constant) is not None:
                return self.mul(self.const(value * inner), b.args[1])
            return self._node("mul", (a, b))
        for x, y in ((a, b), (b, a)):
            if x.op == "div" and x.args[1] is y:
                return x.args[0]
            if x.op == "mul" and (factor := x.args[0].constant) is not None:
                return self.mul(self.const(factor), self.mul(x.args[1], y))
        if a.serial > b.serial:
            a, b = b, a
        return self._node("mul", (a, b))

    def div(self, a: Scalar, b: Scalar) -> Scalar:
        """a / b; a constant divisor becomes an exact factor."""
        if a.is_zero:
            return a
        if (value := b.constant) is not None and value != 0:
            return self.mul(self.const(1 / value), a)
        if a is b:
            return self.one
        if a.op == "neg":
            return self.neg(self.div(a.args[0], b))
        if b.op == "neg":
            return self.neg(self.div(a, b.args[0]))
        if a.op == "mul" and b in a.args:
            return a.args[1] if a.args[0] is b else a.args[0]
        if b.op == "abs" and b.args[0] is a:
            return self.function("copysign", (self.one, a))
        if b.op == "mul" and a in b.args:
            return self.div(self.one, b.args[1] if b.args[0] is a else b.args[0])
        if b.op == "div":
            return self.div(self.mul(a, b.args[1]), b.args[0])
        return self._node("div", (a, b))

    def power(self, base: Scalar, exponent: Fraction) -> Scalar:
        """base ** exponent: products and square roots where they serve."""
        product = expanded(self, base, exponent)
        return self._node("pow", (base,), exponent) if product is None else product

    def function(self, name: str, args: tuple[Scalar, ...]) -> Scalar:
        """One of the functions of the expression language, or abs, copysign, ratio_or_zero, min, max, rounded."""
        if name in ("sin", "cos"):
            return self.trig(name, args[0])
        if name == "rounded":
            return self.rounded(args[0])
        simpler = simplified(self, name, args)
        return self._node(name, args) if simpler is None else simpler

    def rounded(self, a: Scalar) -> Scalar:
        """The number that is computed for a, of which nothing else is known: what it lacks of a can be worked out."""
        return a if a.constant is not None or a.op in ("symbol", "rounded") else self._node("rounded", (a,))

    def trig(self, name: str, argument: Scalar) -> Scalar:
        """Sine or cosine, keyed by the integer combination of leaves in its argument; its sign is pulled out."""
        negative, angle = self._angles.upright(argument)
        if angle.is_zero:
            return self.zero if name == "sin" else self.one
        value = self._node(name, (angle,))
        return self.neg(value) if negative and name == "sin" else value
