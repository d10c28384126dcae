"""Which names a model may use, and the nearest known name to a misspelt one."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from symgen.diagnostics import Mistake
from symgen.model.expressions.expression import FUNCTION_ARITY
from symgen.registered import keywords

if TYPE_CHECKING:  # the command line corrects misspelt options too, and needs no YAML for that
    from symgen.model.file.source import ScalarNode

# Characters of a name.
MAXIMUM_NAME = 40
# Names in a remedy.
MOST_LISTED = 10
# Likeness of a name that is meant for sure, and of one that may be.
SLIP, LIKENESS = 0.9, 0.65
# Names that count on, from which they are shown by their first and last.
SHORTEST_RUN = 4
NAME_PATTERN = "[A-Za-z][A-Za-z0-9_]*"
QUOTING = "inside { } and [ ] quote an expression or text that has a comma, colon, bracket or #, or use block style"
_NAME = re.compile(NAME_PATTERN, re.ASCII)

RESERVED: dict[str, str] = {
    **keywords(),
    **dict.fromkeys(FUNCTION_ARITY, "a function of the language"),
    "pi": "the number pi",
    "t": "the time",
    **dict.fromkeys(("null", "true", "false"), "a word of YAML"),
}


def counted(number: int, noun: str) -> str:
    """`1 row`, `2 rows`."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def shown_names(names: Iterable[str]) -> str:
    """Names in backticks; those that count on are shown as `b_1` .. `b_10`."""
    shown: list[str] = []
    run: list[str] = []

    def close() -> None:
        shown.extend([f"`{run[0]}` .. `{run[-1]}`"] if len(run) >= SHORTEST_RUN else [f"`{name}`" for name in run])
        run.clear()

    for name in names:
        if run and _successor(run[-1]) != name:
            close()
        run.append(name)
    close()
    return ", ".join(shown)


def _successor(name: str) -> str | None:
    """The name with the number at its end one higher."""
    digits = re.search(r"(0|[1-9][0-9]*)$", name)
    return None if digits is None else f"{name[: digits.start()]}{int(digits[0]) + 1}"


def is_name(text: str) -> bool:
    """Whether `text` has the form of a name, reserved or not."""
    return _NAME.fullmatch(text) is not None


def name_mistake(node: ScalarNode, what: str) -> Mistake | None:
    """What is wrong with `node` as a name of a `what` ("coordinate"); None for a good name."""
    name = node.value
    shown = name if len(name) <= MAXIMUM_NAME else name[:MAXIMUM_NAME] + "..."
    if not _NAME.fullmatch(name):
        message = f"`{shown}` is no name for a {what}"
        remedy = "names start with a letter and go on with letters a-z, A-Z, digits and _"
        if set(name) & set("()[]+*, "):
            remedy = QUOTING
        if _NAME.fullmatch(joined := re.sub("[ .-]+", "_", name.strip())):
            remedy = f"write it in one word, such as `{joined}`"
        return Mistake(message, remedy, node.span)
    if len(name) > MAXIMUM_NAME:
        message = f"the name `{shown}` has {len(name)} characters, at most {MAXIMUM_NAME} are allowed"
        return Mistake(message, "choose a shorter name, and say more in its description", node.span)
    if name in RESERVED:
        return Mistake(f"`{name}` is reserved: {RESERVED[name]}", f"rename it, for example to `{name}_1`", node.span)
    if name.endswith(("_dot", "_ddot")):
        message = f"`{name}` is reserved: names in _dot and _ddot are rates and accelerations of coordinates"
        return Mistake(message, "choose another ending", node.span)
    return None


def did_you_mean(name: str, known: Iterable[str], otherwise: str) -> str:
    """The remedy for an unknown name: the nearest known one, else `otherwise`."""
    near = nearest(name, sorted(known))
    return f"did you mean `{near}`?" if near else otherwise


def nearest(name: str, candidates: Sequence[str]) -> str:
    """The nearest candidate, or empty: in other capitals, by a slip, begun the same, a few letters apart."""
    same = [one for one in candidates if one.lower() == name.lower()]
    long = [one for one in candidates if min(len(one), len(name)) > 2]
    begun = [one for one in long if one.startswith(name) or name.startswith(one)]
    slip = difflib.get_close_matches(name, candidates, 1, SLIP)
    near = same or slip or sorted(begun, key=lambda one: abs(len(one) - len(name)))
    near = near or difflib.get_close_matches(name, candidates, 1, LIKENESS)
    return near[0] if near else ""
