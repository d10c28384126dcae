"""Denominators a result depends on, and how small is too small.

A kernel decides on its own denominators: the status is not OK where |D| <= threshold * D_max, with D_max the sum of
the absolute terms of D when every sine and cosine is 1, or what D would be if nothing were lost.  Of the pivots of a
definite matrix D itself is compared.

A status says that one direction is all but lost.  A determinant is what is left of several directions multiplied, and
where each of them is a little poor it is small without any of them being lost.  So pivots are compared one by one, each
with what it is left of, and the threshold of a determinant falls with the number of its directions, down to what
rounding leaves of one that is 0.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

from symgen.ir.kernel import Status
from symgen.records import dataclass
from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import reached, substitute, topological

# What a direction may be shorter by, in lengths or in squares, without being lost.
POORER = 6
# In units of eps: what rounding may leave of a determinant that is 0, rounded angles included.
LEFT = 8


@dataclass(frozen=True, slots=True)
class Guard:
    """Return `status` where `denominator` is negligible.

    `degree` is 2 for a sum of squares (the threshold is squared), else 1.  `first` holds guards that are looked at
    only on failure, to name the cause.  `scale` takes the place of D_max where another factor of the denominator
    has a guard of its own.  `directions` is how many the denominator is a determinant of, in this scale.  One that is
    `positive` is lost below 0, too: pivots of a definite matrix are lengths to what comes after them.  One to be
    `small` fails where it is not negligible.
    """

    status: Status
    denominator: Scalar
    degree: int
    first: tuple[Guard, ...] = ()
    scale: Scalar | None = None
    directions: int = 1
    positive: bool = False
    small: bool = False

    def threshold(self, n: int, unit_roundoff: Fraction) -> Fraction:
        """8 n eps for one direction, n eps for determinants of three or more; squared for sums of squares."""
        loss = LEFT if self.directions > 2 else POORER if self.directions == 2 else 1
        return (max(Fraction(LEFT * n, loss), Fraction(LEFT)) * unit_roundoff) ** self.degree


def tested(guards: Iterable[Guard]) -> tuple[Guard, ...]:
    """Those that a state can fail: a denominator that is a number is settled when code is made."""
    return tuple(guard for guard in guards if guard.denominator.constant is None)


def moved(guard: Guard, replacements: Mapping[Scalar, Scalar]) -> Guard:
    """A guard without causes where symbols are something else, measured by what it is made of now."""
    graph = guard.denominator.graph
    scale = magnitude(graph, [guard.denominator])[0] if guard.scale is None else guard.scale
    denominator, scale = substitute(graph, [guard.denominator, scale], replacements)
    return replace(guard, denominator=denominator, scale=scale)


def beside_lengths(status: Status, pivots: Sequence[Scalar], lengths: Sequence[Scalar]) -> tuple[Guard, ...]:
    """One guard for each squared pivot: what is left of a vector beside the vectors before, and its squared length."""
    pairs = list(zip(pivots, lengths, strict=True))
    moving = [pair for pair in pairs if pair[0] is not pair[1] or pair[0].constant is None]
    return tuple(Guard(status, pivot, 2, scale=length) for pivot, length in moving)


def multiplied(status: Status, pivots: Sequence[Scalar], lengths: Sequence[Scalar]) -> tuple[Guard, ...]:
    """The guard of squared pivots where a step loses again what the steps before have lost.

    What one direction of several loses ordinarily hardly counts: else many of them would be taken for a lost one.  Of a
    share s it is 6 s / (1 + 5 s), and no smaller of two: compilers make jumps of such a choice.
    """
    guards = beside_lengths(status, pivots, lengths)
    if len(guards) < 2:
        return guards
    graph = pivots[0].graph
    pairs = [(pivot, length) for pivot, length in zip(pivots, lengths, strict=True) if pivot is not length]
    kept = [POORER * pivot / (length + (POORER - 1) * pivot) for pivot, length in pairs]
    return (Guard(status, graph.product(kept), 2, scale=graph.one),)


def where_negligible(graph: Graph, total: Scalar, values: Sequence[Scalar]) -> list[Scalar]:
    """Values as they are where a sum of squares is 0 to rounding; as they stand if `total` is no sum of squares.

    Each root of its squares is 0 then, and the cosine of an angle whose sine is 0 is 1 or -1.  It is replaced where
    both signs give the same values, that is where it stands in squares.  Values with quotients stay as they stand.
    """
    roots = _roots(total)
    if any(node.op in ("div", "ratio_or_zero") for node in reached(values)):
        return list(values)
    replaced = substitute(graph, values, dict.fromkeys(roots, graph.zero))
    for root in roots:
        if root.op == "sin":
            cosine = graph.trig("cos", root.args[0])
            either = [substitute(graph, replaced, {cosine: sign}) for sign in (graph.one, -graph.one)]
            if either[0] == either[1]:
                replaced = either[0]
    return replaced


def _roots(total: Scalar) -> list[Scalar]:
    """What the terms of a sum are squares of; none if there is a term that is no square."""
    terms, roots = [total], []
    while terms:
        term = terms.pop()
        if term.op == "add":
            terms += term.args
        elif term.op == "mul" and term.args[0] is term.args[1]:
            roots.append(term.args[0])
        else:
            return []
    return roots


def lost_only_at_zero(guard: Guard) -> bool:
    """Whether a denominator is as large as its scale, or D_max, wherever it is.

    A pivot of a definite matrix in which nothing cancels is right to all its digits, however small it is beside what it
    is left of: a slide of a milligram between two that carry a tonne.
    """
    denominator, scale = guard.denominator, guard.scale
    if scale is denominator:
        return True
    if not _loses_nothing(denominator):
        return False
    largest = magnitude(denominator.graph, [denominator])[0]
    return guard.positive or scale is None or scale.value == largest.value


def _loses_nothing(scalar: Scalar) -> bool:
    """Whether nothing cancels in it: products, quotients and functions, and sums of what is never below 0."""
    whole: dict[Scalar, bool] = {}
    positive: dict[Scalar, bool] = {}
    for node in topological([scalar]):
        args = node.args
        kept = [positive[x] for x in args]
        match node.op:
            case "mul":
                positive[node] = args[0] is args[1] or all(kept)
            case "div" | "add":
                positive[node] = all(kept)
            case op:
                positive[node] = op in ("abs", "sqrt") or (node.constant is not None and node.constant > 0)
        whole[node] = node.op not in ("sub", "sin", "cos") and all(whole[x] for x in args)
        whole[node] &= node.op != "add" or positive[node]
    return whole[scalar]


def magnitude(graph: Graph, outputs: Sequence[Scalar]) -> list[Scalar]:
    """Upper bounds of |output| for every angle: sums of absolute terms with sines and cosines set to 1."""
    bound: dict[Scalar, Scalar] = {}
    for node in topological(outputs):
        args = [bound[argument] for argument in node.args]
        match node.op:
            case "sin" | "cos":
                bound[node] = graph.one
            case "add" | "sub":
                bound[node] = args[0] + args[1]
            case "mul":
                bound[node] = args[0] * args[1]
            case "neg" | "abs" | "copysign" | "rounded":
                bound[node] = args[0]
            case "div":
                bound[node] = args[0] / graph.function("abs", (node.args[1],))
            case "sqrt":
                bound[node] = graph.function("sqrt", (args[0],))
            case _:
                bound[node] = graph.function("abs", (node,))
    return [bound[output] for output in outputs]
