"""Python values as text of the model language: numbers, SymPy expressions, lists and mappings of them, as YAML."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any, TypeAlias

import yaml

# Texts in lists and mappings: what a model file holds.
Block: TypeAlias = "str | list[Block] | dict[str, Block]"
# Columns of the file.
FILE_COLUMNS = 110
_TAGS: dict[type[yaml.Node], str] = {
    yaml.ScalarNode: "tag:yaml.org,2002:str",
    yaml.SequenceNode: "tag:yaml.org,2002:seq",
    yaml.MappingNode: "tag:yaml.org,2002:map",
}
# What the rates and accelerations of x are called, by the order of the derivative.
_RATES = {1: "_dot", 2: "_ddot"}


def as_block(value: Any) -> Block:
    """The value in texts: numbers to the last digit, SymPy expressions and matrices in the grammar of the language.

    Functions of time, as `dynamicsymbols` of SymPy makes them, stand for coordinates, their derivatives for rates and
    accelerations.  Raises TypeError for a value that means nothing in a model file.
    """
    if isinstance(value, str):
        return value
    if isinstance(value, Mapping):
        return {str(name): as_block(entry) for name, entry in value.items()}
    if _is_sympy(value):
        return _of_sympy(value)
    if isinstance(value, (list, tuple)):
        return [as_block(entry) for entry in value]
    if hasattr(value, "tolist"):  # numbers and arrays of NumPy
        return as_block(value.tolist())
    if isinstance(value, (int, float, Fraction)) and not isinstance(value, bool):
        return str(value) if isinstance(value, Fraction) else repr(value)
    raise TypeError(f"{value!r} is none of text, number, expression, list, mapping: nothing of a model file")


def as_yaml(blocks: Mapping[str, Block]) -> str:
    """The model file, an entry of a block on one line where it fits."""
    laid_out = {
        name: {key: _on_a_line(entry) for key, entry in block.items()} if isinstance(block, dict) else _on_a_line(block)
        for name, block in blocks.items()
    }
    return yaml.dump(
        laid_out, Dumper=_TextDumper, sort_keys=False, allow_unicode=True, width=FILE_COLUMNS, default_flow_style=False
    )


def as_blocks(text: str) -> dict[str, Block]:
    """The blocks of a model file that has been read without mistakes."""
    blocks: dict[str, Block] = yaml.load(text, Loader=yaml.BaseLoader)
    return blocks


class _MappingOnALine(dict[str, Block]):
    """A mapping that is written on one line."""


class _ListOnALine(list[Block]):
    """A list that is written on one line."""


def _on_a_line(block: Block) -> Block:
    """The mapping or list marked where it fits on a line, or else as much of it as does."""
    if isinstance(block, str):
        return block
    if len(str(block)) < FILE_COLUMNS:
        return _MappingOnALine(block) if isinstance(block, dict) else _ListOnALine(block)
    if isinstance(block, dict):
        return {key: _on_a_line(entry) for key, entry in block.items()}
    return [_on_a_line(entry) for entry in block]


class _TextDumper(yaml.SafeDumper):
    """Writes texts as they are: nobody takes `0.5`, `no` or `1e-3` for anything else in a model file."""

    def resolve(self, kind: type[yaml.Node], _value: Any, _implicit: Any) -> str:
        """Every scalar is a text, whatever it looks like."""
        return _TAGS[kind]


def _mapping(dumper: _TextDumper, line: _MappingOnALine) -> yaml.Node:
    return dumper.represent_mapping(_TAGS[yaml.MappingNode], line, flow_style=True)


def _list(dumper: _TextDumper, line: _ListOnALine) -> yaml.Node:
    return dumper.represent_sequence(_TAGS[yaml.SequenceNode], line, flow_style=True)


_TextDumper.add_representer(_MappingOnALine, _mapping)
_TextDumper.add_representer(_ListOnALine, _list)


def _is_sympy(value: Any) -> bool:
    return any(kind.__module__.startswith("sympy.") for kind in type(value).__mro__)


def _of_sympy(value: Any) -> Block:
    import sympy
    from sympy.core.function import AppliedUndef
    from sympy.printing.str import StrPrinter

    class LanguagePrinter(StrPrinter):  # type: ignore[misc]  # SymPy has no types
        """The spelling of the language."""

        def _print_Float(self, number: Any) -> str:
            return repr(float(number))

        def _print_Exp1(self, _: Any) -> str:
            return "exp(1)"

    if isinstance(value, sympy.MatrixBase):
        rows = value.tolist()
        return as_block([row[0] for row in rows] if value.cols == 1 else rows)
    moving: dict[Any, Any] = {}
    for derivative in value.atoms(sympy.Derivative):
        (_, order), *others = derivative.variable_count
        inner = derivative.expr
        if others or not isinstance(inner, AppliedUndef) or int(order) not in _RATES:
            raise TypeError(f"{derivative} is no rate or acceleration of a coordinate")
        moving[derivative] = sympy.Symbol(inner.func.__name__ + _RATES[int(order)])
    value = value.xreplace(moving)
    value = value.xreplace({one: sympy.Symbol(one.func.__name__) for one in value.atoms(AppliedUndef)})
    text: str = LanguagePrinter().doprint(value)
    return text
