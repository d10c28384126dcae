"""Names say what something is, not that it was found or told; names of tests are sentences and may."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
ANYWHERE = re.compile(r"(found|told|tells|feels|stands_out)[_\W]", re.IGNORECASE)
WORDS = re.compile(r"(^|_)(found|told|tells|feels|stands_out)(_|$)", re.IGNORECASE)


def assigned(tree: ast.AST) -> Iterator[str]:
    """The names that a file gives."""
    for node in ast.walk(tree):
        match node:
            case ast.FunctionDef(name=name) | ast.ClassDef(name=name) | ast.arg(arg=name):
                yield name
            case ast.Name(id=name, ctx=ast.Store()) | ast.Attribute(attr=name, ctx=ast.Store()):
                yield name


def test_no_name_says_that_something_was_found_or_told() -> None:
    files = [path for folder in ("symgen", "tests", "tools") for path in sorted((ROOT / folder).rglob("*.py"))]
    assert len(files) > 500
    texts = ((path.name, path.read_text(encoding="utf-8")) for path in files)
    given = {(file, name) for file, text in texts if ANYWHERE.search(text) for name in assigned(ast.parse(text))}
    assert {(file, name) for file, name in given if WORDS.search(name) and not name.startswith("test_")} == set()
