"""Options that several commands share, and what may stand behind them."""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn

from symgen.generation.results import ALL_PARTS, AUTO, DEFAULT_STATES, NAMED_METHODS, TRIG
from symgen.methods.table import label
from symgen.model.expressions.names import did_you_mean, nearest

# States that a user may ask for at least: with fewer a verification would say too little.
FEWEST_ASKED_FOR = 8
USUAL = "inverse_dynamics"
SHELLS = ("bash", "zsh", "fish")
# Names that methods once had.
FORMER = {(USUAL, "range"): "elimination"}
UNKNOWN = "unrecognized arguments: "  # how argparse begins


class _OptionParser(argparse.ArgumentParser):
    """A parser that knows what a misspelt option was meant to be."""

    def error(self, message: str) -> NoReturn:
        """The message with the nearest option for each that is unknown."""
        _, separator, unknown = message.partition(UNKNOWN)
        options = [option for action in self._actions for option in action.option_strings]
        given = [word.partition("=")[0] for word in unknown.split() if word.startswith("--")] if separator else []
        meant = {word: near for word in given if (near := nearest(word, options))}
        super().error(message + "".join(f"\n  did you mean `{near}` for `{word}`?" for word, near in meant.items()))


def make_parser(program: str, description: str, epilog: str | None = None) -> argparse.ArgumentParser:
    """A parser that wants options in full."""
    form = argparse.RawDescriptionHelpFormatter
    return _OptionParser(
        program, description=description, epilog=epilog, formatter_class=form, allow_abbrev=False
    )


def add_models(parser: argparse.ArgumentParser) -> None:
    """MODEL.yaml, once or more."""
    parser.add_argument("models", metavar="MODEL.yaml", type=Path, nargs="+", help="model files")


def add_out(parser: argparse.ArgumentParser, does: str = "writes DIR/<model>/ (default: generated)") -> None:
    """--out."""
    parser.add_argument("--out", metavar="DIR", type=Path, default=Path("generated"), help=does)


def add_quiet(parser: argparse.ArgumentParser) -> None:
    """--quiet."""
    parser.add_argument("--quiet", action="store_true", help="print mistakes and failures only")


def add_generation(parser: argparse.ArgumentParser) -> None:
    """What generation and verification share: --out, --states, --method, --trig, --contract, --quiet."""
    add_out(parser)
    parser.add_argument(
        "--states",
        metavar="N",
        type=number_of_states,
        default=DEFAULT_STATES,
        help=f"states to verify (default: {DEFAULT_STATES})",
    )
    add_method(parser)
    parser.add_argument(
        "--trig",
        choices=TRIG,
        default="portable",
        help="sine and cosine: portable has the same bits everywhere, libm calls the library's (default: portable)",
    )
    parser.add_argument(
        "--contract",
        action="store_true",
        help="verify the batches with -ffp-contract=fast -DSYMGEN_CONTRACT, too: faster, with other bits",
    )
    add_quiet(parser)


def add_method(parser: argparse.ArgumentParser) -> None:
    """--method, once for each quantity."""
    parser.add_argument(
        "--method",
        "--form",
        metavar="[QUANTITY=]METHOD",
        type=method_of,
        action="append",
        default=[],
        dest="methods",
        help="how a quantity is computed: "
        + "; ".join(f"{quantity}: {_offered(quantity)}" for quantity in NAMED_METHODS)
        + f"; {AUTO}: the cheapest valid at every regular state (default); without QUANTITY: {USUAL}; repeatable",
    )


def _offered(quantity: str) -> str:
    """The methods of a quantity by name; those of a use that has to be told stand together behind it."""
    by_label: dict[str, list[str]] = {}
    for method in NAMED_METHODS[quantity]:
        by_label.setdefault(label(quantity, method), []).append(method)
    return ", ".join(f"{heading} {_listed(methods)}".lstrip() for heading, methods in by_label.items())


def _listed(methods: Sequence[str]) -> str:
    """Names with spaces between them, so that lines end there."""
    return " or ".join(filter(None, (", ".join(methods[:-1]), methods[-1])))


def method_of(text: str) -> tuple[str, str]:
    """`schur_qr` of `multipliers=schur_qr` with its quantity; a method alone is one of the inverse dynamics."""
    quantity, given, method = text.rpartition("=")
    quantity = quantity if given else USUAL
    if quantity not in NAMED_METHODS:
        remedy = did_you_mean(quantity, [*NAMED_METHODS], f"those that have methods are {', '.join(NAMED_METHODS)}")
        raise argparse.ArgumentTypeError(f"{quantity!r} has no methods; {remedy}")
    method = FORMER.get((quantity, method), method)
    if method != AUTO and method not in NAMED_METHODS[quantity]:
        choices = ", ".join((AUTO, *NAMED_METHODS[quantity]))
        raise argparse.ArgumentTypeError(f"{method!r} is no method of {quantity}: choose from {choices}")
    return quantity, method


def chosen_methods(given: Sequence[tuple[str, str]]) -> dict[str, str]:
    """By quantity what was asked for last."""
    return {quantity: method for quantity, method in dict(given).items() if method != AUTO}


def names(text: str) -> tuple[str, ...]:
    """`a,b`, each once."""
    distinct = tuple(dict.fromkeys(name.strip() for name in text.split(",") if name.strip()))
    if not distinct:
        raise argparse.ArgumentTypeError("expected names separated by commas")
    return distinct


def parts(text: str) -> tuple[str, ...]:
    """`c,python`, in the order in which they are made."""
    given = names(text)
    if unknown := [name for name in given if name not in ALL_PARTS]:
        raise argparse.ArgumentTypeError(f"{unknown[0]!r} is none of {', '.join(ALL_PARTS)}")
    return tuple(part for part in ALL_PARTS if part in given)


def number_of_states(text: str) -> int:
    """A whole number that leaves enough to judge by."""
    try:
        count = int(text)
    except ValueError:
        count = 0
    if count < FEWEST_ASKED_FOR:
        raise argparse.ArgumentTypeError(f"{text!r} is no whole number from {FEWEST_ASKED_FOR} up")
    return count


def positive(text: str) -> float:
    """A positive number."""
    value = _number(text)
    if not value > 0:
        raise argparse.ArgumentTypeError(f"{text!r} is no positive number")
    return value


def not_negative(text: str) -> float:
    """A number that is 0 or more."""
    value = _number(text)
    if not value >= 0:
        raise argparse.ArgumentTypeError(f"{text!r} is below 0")
    return value


def seed(text: str) -> int:
    """A whole number from 0 up."""
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"{text!r} is no whole number from 0 up")
    return int(text)


def two_weights(text: str) -> tuple[float, float]:
    """`1,0.1` as two positive numbers."""
    numbers = [positive(part.strip()) for part in text.split(",")]
    if len(numbers) != 2:
        raise argparse.ArgumentTypeError(f"{text!r} are no two positive numbers, such as 1,0.1")
    return numbers[0], numbers[1]


def values(text: str) -> dict[str, float]:
    """`a=1,b=2` as a mapping."""
    by_name: dict[str, float] = {}
    for entry in filter(None, map(str.strip, text.split(","))):
        name, _, number = entry.partition("=")
        by_name[name.strip()] = value = _number(number)
        if not math.isfinite(value):
            raise argparse.ArgumentTypeError(f"{entry!r} is not of the form x=1")
    return by_name


def _number(text: str) -> float:
    """A finite number, or NaN."""
    try:
        value = float(text)
    except ValueError:
        return math.nan
    return value if math.isfinite(value) else math.nan
