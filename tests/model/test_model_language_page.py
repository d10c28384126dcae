"""The page docs/model-language.md is true: its examples load, and every block and function is there."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from symgen.model.expressions.expression import FUNCTION_ARITY
from symgen.model.file.schema import MODEL
from symgen.model.load import load_text
from symgen.quantities.everything import OPERATIONS_OF_ALL

PAGE = (Path(__file__).parents[2] / "docs" / "model-language.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"```yaml\n(.*?)```", PAGE, re.DOTALL)
ROBOT = re.findall(r"```xml\n(.*?)```", PAGE, re.DOTALL)


@pytest.mark.parametrize("text", EXAMPLES, ids=lambda text: text.split("\n")[0][7:30])
def test_examples_load(text: str, tmp_path: Path) -> None:
    (tmp_path / "robot.urdf").write_text(ROBOT[0], encoding="utf-8")
    load_text(text, str(tmp_path / "example.yaml"))


def test_there_are_examples() -> None:
    assert len(EXAMPLES) >= 4


def test_every_block_is_described() -> None:
    for field in MODEL.fields:
        assert f"`{field.key}`" in PAGE, field.key


def test_every_function_is_listed() -> None:
    assert f"`{' '.join(FUNCTION_ARITY)}`" in PAGE


def test_what_all_takes_is_the_limit_of_the_code() -> None:
    assert f"more than {OPERATIONS_OF_ALL:,} operations".replace(",", " ") in PAGE
