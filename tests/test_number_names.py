"""One name, one number, and a sentence beside it that says what it limits; the laboratory is left out."""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

PACKAGE = Path(__file__).parent.parent / "symgen"
LABORATORY = "laboratory"
NUMBERS = {"Fraction", "Decimal", "int", "float"}


@dataclass(frozen=True)
class NamedNumbers:
    """A statement at the level of a module that gives numbers names: where, which names, and whether it says why."""

    place: str
    names: tuple[str, ...]
    explained: bool


@cache
def named_numbers(package: Path) -> tuple[NamedNumbers, ...]:
    return tuple(_named_numbers(package))


def _named_numbers(package: Path) -> Iterator[NamedNumbers]:
    for path in sorted(package.rglob("*.py")):
        if LABORATORY in path.relative_to(package).parts:
            continue
        text = path.read_text(encoding="utf-8")
        lines, body = text.splitlines(), ast.parse(text).body
        for statement, below in zip(body, (*body[1:], None), strict=True):
            if names := _names(statement):
                above = lines[statement.lineno - 2] if statement.lineno > 1 else ""
                place = f"{path.relative_to(package)}:{statement.lineno}"
                yield NamedNumbers(place, names, above.startswith("# ") or _is_text(below))


def _names(statement: ast.stmt) -> tuple[str, ...]:
    """What a statement names, where all of that is numbers."""
    match statement:
        case ast.Assign(targets=[target], value=value) | ast.AnnAssign(target=target, value=ast.expr() as value):
            values = value.elts if isinstance(value, ast.Tuple) else [value]
            targets = target.elts if isinstance(target, ast.Tuple) else [target]
            if values and all(map(_is_number, values)):
                return tuple(one.id for one in targets if isinstance(one, ast.Name))
    return ()


def _is_number(value: ast.expr) -> bool:
    """Whether it is written as a number: what is computed from names follows from these."""
    match value:
        case ast.Constant(value=number):
            return type(number) in (int, float)
        case ast.UnaryOp(operand=operand):
            return _is_number(operand)
        case ast.BinOp(left=left, right=right):
            return _is_number(left) and _is_number(right)
        case ast.Call(func=ast.Name(id=name), args=arguments):
            return name in NUMBERS and all(isinstance(one, ast.Constant) or _is_number(one) for one in arguments)
    return False


def _is_text(below: ast.stmt | None) -> bool:
    return isinstance(below, ast.Expr) and isinstance(below.value, ast.Constant) and isinstance(below.value.value, str)


def shared_names(package: Path) -> list[str]:
    places = defaultdict(list)
    for numbers in named_numbers(package):
        for name in numbers.names:
            places[name].append(numbers.place)
    return [f"{name}: {', '.join(where)}" for name, where in places.items() if len(where) > 1]


def unexplained(package: Path) -> list[str]:
    return [f"{one.place} {', '.join(one.names)}" for one in named_numbers(package) if not one.explained]


def test_a_name_stands_for_one_number_in_the_whole_package() -> None:
    assert shared_names(PACKAGE) == []


def test_each_number_with_a_name_says_what_it_limits() -> None:
    assert unexplained(PACKAGE) == []


def test_numbers_are_found_however_they_are_written(tmp_path: Path) -> None:
    texts = {
        "gears.py": "# Teeth.\nTEETH = 12\nSLACK: float = 2.0**-20\n",
        "belts.py": 'WIDTH, TEETH = 3, -1\n"""Of a belt."""\nNAME, SIZE = "b", 1\n\n# Ends.\nENDS = (0.5, 1e3)\n',
        "chains.py": "from fractions import Fraction\n\nSLACK = Fraction(1, 3)  # of a link\nTWICE = 2 * SLACK\n",
        "laboratory/chains.py": "TEETH = 7\n",
    }
    for name, text in texts.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    assert shared_names(tmp_path) == ["TEETH: belts.py:1, gears.py:2", "SLACK: chains.py:3, gears.py:3"]
    assert unexplained(tmp_path) == ["chains.py:3 SLACK", "gears.py:3 SLACK"]
    assert [one.names for one in named_numbers(tmp_path)] == [
        ("WIDTH", "TEETH"), ("ENDS",), ("SLACK",), ("TEETH",), ("SLACK",)
    ]
