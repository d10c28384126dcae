"""Rules of setting shared by both translations into layout: where parentheses stand and how functions look."""

from __future__ import annotations

from itertools import groupby

from symgen.report.mathematics.layout import (
    Accent,
    Application,
    Fenced,
    Fraction,
    Layout,
    Letter,
    Numeral,
    Product,
    Punctuation,
    Root,
    Row,
    Scripts,
    Sum,
)

ARC = {"asin": "arcsin", "acos": "arccos", "atan": "arctan", "acot": "arccot", "log": "ln"}


def is_atom(node: Layout) -> bool:
    """A letter or number, perhaps with indices or a dot, that needs no parentheses anywhere."""
    if isinstance(node, Scripts):
        return node.upper is None and is_atom(node.base)
    return isinstance(node, (Letter, Numeral, Accent))


def bare_argument(node: Layout) -> bool:
    """Whether a function may stand before this argument without parentheses: an atom, or a number times an atom."""
    if isinstance(node, Product):
        first, *rest = node.factors
        return len(rest) == 1 and isinstance(first, Numeral) and is_atom(rest[0])
    return is_atom(node)


def as_factor(node: Layout) -> Layout:
    """The node inside a product: sums are set in parentheses."""
    return Fenced(node) if isinstance(node, Sum) else node


def as_base(node: Layout) -> Layout:
    """The node under an exponent."""
    if isinstance(node, Fenced) or is_atom(node):
        return node
    return Fenced(node)


def power(base: Layout, exponent: Layout) -> Layout:
    """base to the exponent; cos²φ for powers of functions."""
    if isinstance(base, Application) and not isinstance(base.function, Scripts):
        return Application(Scripts(base.function, None, exponent), base.argument)
    base = as_base(base)
    if isinstance(base, Scripts) and base.upper is None:
        return Scripts(base.base, base.lower, exponent)
    return Scripts(base, None, exponent)


def call(name: str, arguments: tuple[Layout, ...]) -> Layout:
    """A function of the expression language applied to its arguments."""
    if name == "sqrt":
        return Root(arguments[0])
    if name == "exp":
        return Scripts(Letter("e", "upright"), None, arguments[0])
    if name == "Abs":
        return Fenced(arguments[0], "|")
    function = Letter(ARC.get(name, name), "upright")
    if len(arguments) == 1:
        argument = arguments[0]
        return Application(function, argument if bare_argument(argument) else Fenced(argument))
    pieces: list[Layout] = []
    for position, argument in enumerate(arguments):
        if position:
            pieces.append(Punctuation(","))
        pieces.append(argument)
    return Application(function, Fenced(Row(tuple(pieces))))


def product(factors: list[Layout]) -> Layout:
    """Factors side by side, functions last: what follows a bare function would read as its argument."""
    flat: list[Layout] = []
    for factor in factors:
        flat.extend(factor.factors if isinstance(factor, Product) else (factor,))
    flat = _powers(flat)
    flat.sort(key=lambda factor: isinstance(factor, Application))
    return flat[0] if len(flat) == 1 else Product(tuple(as_factor(factor) for factor in flat))


def _powers(factors: list[Layout]) -> list[Layout]:
    """The factors, with powers of letters in place of equal ones that follow each other."""
    runs = [list(run) for _, run in groupby(factors)]
    return [
        factor
        for first, *others in runs
        for factor in (
            [power(first, Numeral(str(1 + len(others))))]
            if others and is_atom(first) and not isinstance(first, Numeral)
            else [first, *others]
        )
    ]


def quotient(numerator: Layout, denominator: Layout) -> Layout:
    """numerator over denominator."""
    return Fraction(numerator, denominator)
