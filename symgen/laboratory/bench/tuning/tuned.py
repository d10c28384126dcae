"""The tuned constants of the derivation: numbers at the heads of modules that limit or weigh something.

A rule that tests hold: such a constant stands on a line of its own, with a comment above it or a string below that says
what it limits, and no two have one name.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[4]
# Packages that no derivation runs through: closed forms of the report, and what follows from verification.
OUTSIDE = ("generation", "closedform")
PACKAGES = (
    "mechanics",
    "linear_algebra",
    "symbolic",
    "validity",
    "methods",
    "quantities",
    "ir",
    "lowering",
    *OUTSIDE,
)
# Seeds, digits, numbers of mathematics and of types, how many of a thing there are, and what messages show.
NOT_TUNED = {
    "PIVOT_SEED", "SEARCH_SEED", "CONSTANT_BITS", "FIELD_BITS", "GRADIENT_BITS", "POINT_DIGITS", "STEPS", "WHOLE",
    "PRIME", "TWO_OVER_PI", "PI", "UNIT_BASE", "BETWEEN_TYPES", "_HEAD", "TIERS", "MOST_NAMES",
    "LONGEST_FORMULA", "LONGEST_TEXT", "DECIMALS", "WIDEST_TEXT", "BITS",
    "_FLOAT32_DIGITS", "_FLOAT32_LOWEST_EXPONENT", "_FLOAT32_LIMIT",
}
# Samples, steps and thresholds of numerical decisions: what they stand for is right or wrong, not long or short.
NUMERICAL = {
    "LOOKED_AT", "LENGTH_POINTS",
    "POINTS_OF_SIGNS", "PIVOT_STARTS", "STEP_HALVINGS", "SEARCH_STARTS", "SEARCH_STEPS",
    "STALLED", "STALLED_STEPS", "MOST_DAMPING", "HIGHEST_POWER",
    "ROUNDING_OF_ZEROS", "ROUNDING_OF_RATIOS", "LARGEST_DENOMINATOR",
    "NEAR", "VANISHED",
    "REGULAR", "SMALLEST", "GAIN", "THRESHOLD_MARGIN", "LEFT", "POORER", "REST", "VANISHING", "NO_PART",
    "NO_LIMIT", "SHORTER", "GAINED", "LOWERED",
    "HALVINGS", "TERMS",
}


@dataclass(frozen=True, slots=True)
class Constant:
    """One of them: its module, name, value as it is written, and what it limits."""

    module: str
    name: str
    value: str
    limits: str

    @property
    def key(self) -> str:
        """Module and name."""
        return f"{self.module}.{self.name}"

    @property
    def outside(self) -> bool:
        """Whether no derivation reads it."""
        return self.module.split(".")[1] in OUTSIDE

    @property
    def numerical(self) -> bool:
        """Whether it is of a numerical decision."""
        return self.name in NUMERICAL


def tuned() -> list[Constant]:
    """All of them, by package and module."""
    files = (file for package in PACKAGES for file in sorted((ROOT / "symgen" / package).rglob("*.py")))
    return [one for file in files for one in _of_module(file)]


def named_number(statement: ast.stmt) -> tuple[str, ast.expr] | None:
    """Name and value of a statement that gives a number a name in capitals."""
    if not isinstance(statement, ast.Assign) or not isinstance(target := statement.targets[0], ast.Name):
        return None
    name = target.id
    return (name, statement.value) if name.isupper() and name not in NOT_TUNED and _is_plain(statement.value) else None


def _is_plain(value: ast.expr) -> bool:
    """Whether it is a number as written, or a fraction of such: what is computed follows from others."""
    if isinstance(value, ast.Call):
        return isinstance(value.func, ast.Name) and value.func.id == "Fraction" and not any(map(_names, value.args))
    return isinstance(value, ast.Constant) and type(value.value) in (int, float)


def _names(value: ast.expr) -> bool:
    return any(isinstance(node, ast.Name) for node in ast.walk(value))


def _of_module(file: Path) -> Iterator[Constant]:
    text = file.read_text(encoding="utf-8")
    module = ".".join(file.relative_to(ROOT).with_suffix("").parts)
    lines = text.splitlines()
    body = ast.parse(text).body
    for statement, below in zip(body, (*body[1:], None), strict=True):
        if named := named_number(statement):
            name, value = named
            comment = _string(below) or _comment(lines, statement.lineno - 1)
            yield Constant(module, name, ast.unparse(value), " ".join(comment.split()))


def _string(below: ast.stmt | None) -> str:
    is_string = isinstance(below, ast.Expr) and isinstance(below.value, ast.Constant)
    return str(ast.literal_eval(below.value)) if is_string and isinstance(below, ast.Expr) else ""


def _comment(lines: Sequence[str], at: int) -> str:
    above = at
    while above and lines[above - 1].startswith("# "):
        above -= 1
    return " ".join(line[2:] for line in lines[above:at])
