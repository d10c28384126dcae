"""Expressions of the model language, by precedence climbing: Python's rules for + - * / ** and nothing of Python.

Numbers stay exact.  Exponents are constants, folded and bounded here.  Everything is limited (length, nesting, digits),
so that no text can exhaust time, memory or the stack of a later stage.
"""

from __future__ import annotations

from fractions import Fraction
from typing import cast

from symgen.diagnostics import Mistake, Span
from symgen.model.expressions.expression import (
    FUNCTION_ARITY,
    Binary,
    BinaryOperator,
    Call,
    Expression,
    FunctionName,
    Name,
    Negation,
    Number,
    Pi,
    Power,
)
from symgen.model.expressions.names import QUOTING, nearest
from symgen.model.expressions.tokens import ExpressionError, Token, tokenize
from symgen.model.file.source import ScalarNode

# Characters of an expression: files are untrusted input.
MAXIMUM_LENGTH = 20_000
# Words of an expression, numbers, operators and parentheses among them.
MAXIMUM_TOKENS = 8_000
# Parentheses, signs and powers inside each other: reading them recurses.
MAXIMUM_NESTING = 60
# Operations on the longest way down a tree: whatever walks an expression recurses.
MAXIMUM_HEIGHT = 200
# Characters of a number without its exponent, and digits of what is computed from numbers.
MAXIMUM_DIGITS = 40
# Powers of ten of a number.
MAXIMUM_DECIMAL_EXPONENT = 300
# Exponents of a power, at most.
MAXIMUM_POWER = 64
# Denominators of an exponent, at most.
MAXIMUM_ROOT = 12
SPLIT_REMEDY = "name parts of it under `definitions`"
QUOTE_REMEDY = f"balance the parentheses; {QUOTING}"
_PRECEDENCE = {"+": 1, "-": 1, "*": 2, "/": 2}


def parse_expression(node: ScalarNode) -> Expression | Mistake:
    """The syntax tree of a scalar of the file, or the first mistake in it, at its place."""
    text = node.value
    try:
        if not text.strip():
            raise ExpressionError("an expression is missing", "write a number or an expression", 0)
        if len(text) > MAXIMUM_LENGTH:
            message = f"an expression of {len(text)} characters, at most {MAXIMUM_LENGTH} are read"
            raise ExpressionError(message, SPLIT_REMEDY, 0)
        return _ExpressionParser(node, tokenize(text)).whole()
    except ExpressionError as mistake:
        return Mistake(mistake.message, mistake.remedy, node.place(mistake.offset, mistake.length))


class _ExpressionParser:
    """One pass over the tokens; each method returns a tree and its height."""

    def __init__(self, node: ScalarNode, tokens: list[Token]) -> None:
        if len(tokens) > MAXIMUM_TOKENS:
            message = f"an expression of {len(tokens)} words, at most {MAXIMUM_TOKENS} are read"
            raise ExpressionError(message, SPLIT_REMEDY, 0)
        self._node, self._tokens, self._next, self._nesting = node, tokens, 0, 0

    def whole(self) -> Expression:
        tree, _ = self._sum(1)
        token = self._tokens[self._next]
        if token.kind != "end":
            raise self._unexpected(token)
        return tree

    def _sum(self, precedence: int) -> tuple[Expression, int]:
        start = self._tokens[self._next]
        left, height = self._signed()
        while True:
            token = self._tokens[self._next]
            strength = _PRECEDENCE.get(token.text, 0) if token.kind == "operator" else 0
            if strength < precedence:
                return left, height
            self._next += 1
            right, right_height = self._sum(strength + 1)
            height = self._checked(max(height, right_height) + 1, token)
            left = Binary(cast(BinaryOperator, token.text), left, right, self._span(start))

    def _signed(self) -> tuple[Expression, int]:
        token = self._tokens[self._next]
        if token.kind == "operator" and token.text in "+-":
            self._next += 1
            self._enter(token)
            operand, height = self._signed()
            self._nesting -= 1
            if token.text == "+":
                return operand, height
            return Negation(operand, self._span(token)), height + 1
        return self._power()

    def _power(self) -> tuple[Expression, int]:
        start = self._tokens[self._next]
        base, height = self._primary()
        token = self._tokens[self._next]
        if token.kind != "operator" or token.text != "**":
            return base, height
        self._next += 1
        self._enter(token)
        exponent_token = self._tokens[self._next]
        exponent_tree, _ = self._signed()
        self._nesting -= 1
        exponent = _exponent(exponent_tree, exponent_token)
        if exponent == 1:
            return base, height
        return Power(base, exponent, self._span(start)), self._checked(height + 1, token)

    def _primary(self) -> tuple[Expression, int]:
        token = self._tokens[self._next]
        if token.kind == "number":
            self._next += 1
            return Number(_number(token), self._span(token)), 1
        if token.kind == "name":
            return self._named(token)
        if token.text != "(":
            raise self._unexpected(token)
        self._next += 1
        self._enter(token)
        inner = self._sum(1)
        self._close(token)
        return inner

    def _named(self, token: Token) -> tuple[Expression, int]:
        self._next += 1
        following = self._tokens[self._next]
        if following.text == "(":
            return self._call(token)
        if following.text == ".":
            return self._component(token)
        if token.text in FUNCTION_ARITY:
            message = f"the function `{token.text}` has no argument"
            raise ExpressionError(message, f"write `{token.text}(...)`", token.offset, len(token.text))
        if token.text == "pi":
            return Pi(self._span(token)), 1
        return Name(token.text, self._span(token)), 1

    def _component(self, owner: Token) -> tuple[Expression, int]:
        """`tip.x`: one name to all later stages."""
        dot, component = self._tokens[self._next], self._tokens[self._next + 1]
        length = len(owner.text) + 1
        if component.kind != "name" or not dot.offset == owner.offset + length - 1 == component.offset - 1:
            message = f"`{owner.text}.` is not followed by the name of a component"
            raise ExpressionError(message, "write it without spaces, as in `tip.x`", owner.offset, length)
        self._next += 2
        return Name(f"{owner.text}.{component.text}", self._span(owner)), 1

    def _call(self, name: Token) -> tuple[Expression, int]:
        if name.text not in FUNCTION_ARITY:
            raise _unknown_function(name)
        opening = self._tokens[self._next]
        self._next += 1
        self._enter(opening)
        arguments = [self._sum(1)]
        while self._tokens[self._next].text == ",":
            self._next += 1
            arguments.append(self._sum(1))
        self._close(opening)
        arity = FUNCTION_ARITY[name.text]
        if len(arguments) != arity:
            takes = "one argument" if arity == 1 else f"{arity} arguments"
            message = f"`{name.text}` takes {takes}, here are {len(arguments)}"
            remedy = "a decimal point is `.`, never a comma" if arity == 1 else "write `atan2(y, x)`"
            raise ExpressionError(message, remedy, name.offset, len(name.text))
        height = self._checked(max(height for _, height in arguments) + 1, name)
        return Call(cast(FunctionName, name.text), tuple(tree for tree, _ in arguments), self._span(name)), height

    def _enter(self, token: Token) -> None:
        self._nesting += 1
        if self._nesting > MAXIMUM_NESTING:
            message = f"parentheses, signs or powers nested deeper than {MAXIMUM_NESTING} levels"
            raise ExpressionError(message, SPLIT_REMEDY, token.offset)

    def _close(self, opening: Token) -> None:
        token = self._tokens[self._next]
        if token.text != ")":
            if token.kind == "end":
                raise ExpressionError("this parenthesis is never closed", QUOTE_REMEDY, opening.offset)
            raise self._unexpected(token)
        self._next += 1
        self._nesting -= 1

    def _checked(self, height: int, token: Token) -> int:
        if height > MAXIMUM_HEIGHT:
            message = f"an expression of more than {MAXIMUM_HEIGHT} terms in a row or levels"
            raise ExpressionError(message, SPLIT_REMEDY, token.offset)
        return height

    def _span(self, start: Token) -> Span:
        last = self._tokens[self._next - 1]
        return self._node.place(start.offset, last.offset + len(last.text) - start.offset)

    def _unexpected(self, token: Token) -> ExpressionError:
        previous = self._tokens[self._next - 1] if self._next else None
        offset, length = token.offset, max(1, len(token.text))
        if token.kind == "end":
            return ExpressionError("the expression ends too early", QUOTE_REMEDY, max(0, offset - 1))
        if token.text == ")":
            empty = previous is not None and previous.text == "("
            message = "there is nothing between these parentheses" if empty else "a `)` without `(`"
            return ExpressionError(message, QUOTE_REMEDY, offset)
        if token.text == ",":
            return self._comma(token, previous)
        if token.text == "//":
            return ExpressionError("`//` is no operator", "write `/`", offset, 2)
        if token.kind in ("number", "name") or token.text == "(":
            message = f"an operator is missing before `{token.text}`"
            return ExpressionError(message, "write `*` for a product", offset, length)
        return ExpressionError(f"`{token.text}` is not expected here", "a number, name or `(` belongs here",
                                 offset, length)  # fmt: skip

    def _comma(self, token: Token, previous: Token | None) -> ExpressionError:
        following = self._tokens[self._next + 1]
        if previous is not None and previous.kind == "number" and following.kind == "number":
            shown = f"{previous.text},{following.text}"
            remedy = f"write `{previous.text}.{following.text}`"
            return ExpressionError(f"`{shown}` has a decimal comma", remedy, previous.offset, len(shown))
        return ExpressionError("a comma outside the arguments of a function", QUOTE_REMEDY, token.offset)


def _unknown_function(name: Token) -> ExpressionError:
    near = nearest(name.text, list(FUNCTION_ARITY))
    known = ", ".join(FUNCTION_ARITY)
    remedy = f"did you mean `{near}`?" if near else f"the functions are {known}; write `*` for a product"
    return ExpressionError(f"`{name.text}` is no function of the language", remedy, name.offset, len(name.text))


def _number(token: Token) -> Fraction:
    mantissa, _, exponent = token.text.lower().partition("e")
    if len(mantissa) > MAXIMUM_DIGITS or len(exponent) > 5 or abs(int(exponent or 0)) > MAXIMUM_DECIMAL_EXPONENT:
        message = f"a number of more than {MAXIMUM_DIGITS} digits or beyond 1e{MAXIMUM_DECIMAL_EXPONENT}"
        raise ExpressionError(message, "choose units in which the number is readable", token.offset, len(token.text))
    return Fraction(token.text)


def _exponent(tree: Expression, token: Token) -> Fraction:
    try:
        value = _constant(tree)
    except (ValueError, ZeroDivisionError):
        message = "the exponent is not a constant rational number"
        remedy = "write exponents as 2, -1, 1/2; other powers as exp(y*log(x))"
        raise ExpressionError(message, remedy, token.offset, len(token.text)) from None
    except OverflowError:
        value = Fraction(MAXIMUM_POWER + 1)
    if abs(value.numerator) > MAXIMUM_POWER or value.denominator > MAXIMUM_ROOT:
        message = f"the exponent is too large: at most {MAXIMUM_POWER}, as a fraction with denominator at most "
        message += f"{MAXIMUM_ROOT}"
        raise ExpressionError(message, "use a smaller exponent", token.offset, len(token.text))
    return value


def _constant(tree: Expression) -> Fraction:
    """The value of an exponent; ValueError where it is no rational constant, OverflowError where it grows too large."""
    match tree:
        case Number(value=value):
            result = value
        case Negation(operand=operand):
            result = -_constant(operand)
        case Binary(operator=operator, left=left, right=right):
            a, b = _constant(left), _constant(right)
            result = {"+": a + b, "-": a - b, "*": a * b}[operator] if operator != "/" else a / b
        case Power(base=base, exponent=exponent) if exponent.denominator == 1:
            result = _constant(base) ** int(exponent)
        case _:
            raise ValueError
    if max(abs(result.numerator), result.denominator) > 10**MAXIMUM_DIGITS:
        raise OverflowError
    return result
