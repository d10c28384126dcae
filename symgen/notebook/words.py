"""The words of the builder, one for each block of the model language, made of the language's own table.

A block of entries with keys has a word in the singular, which takes the name and the keys:
`joint("shoulder", "revolute", parent="base", axis="z")`.  A block of named expressions takes a name and an expression,
or any number of them by keyword: `configuration(x=0, a=0.3)`.  Every other block is set as a whole by its own name:
`kinetic_energy("m/2*x_dot**2")`, `outputs("inverse_dynamics", "multipliers")`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from inspect import Parameter, Signature
from typing import Any, Literal

from symgen.model.expressions.names import did_you_mean
from symgen.model.file.schema import MODEL
from symgen.model.file.shape import Either, Key, RecordShape, Shape, TableShape

# Of one entry of each block that has named ones.
SINGULAR = {
    "coordinates": "coordinate",
    "parameters": "parameter",
    "definitions": "definition",
    "frames": "frame",
    "bodies": "body",
    "rotor_inertias": "rotor_inertia",
    "joints": "joint",
    "loops": "loop",
    "springs": "spring",
    "forces": "force",
    "points": "point",
    "inputs": "input",
    "applied_forces": "applied_force",
    "ranges": "range",
    "paths": "path",
}
_NAME = Parameter("name", Parameter.POSITIONAL_ONLY)


@dataclass(frozen=True)
class BlockWord:
    """A word, the block it fills (from the outside), what it takes, and what that is for."""

    word: str
    block: tuple[str, ...]
    fills: Literal["an entry", "named values", "keys", "a value"]
    signature: Signature
    about: str
    keys: tuple[Key, ...] = ()

    def filled(self, before: Any, *given: Any, **keywords: Any) -> Any:
        """The block as it is after the word, `before` being what it was, or None.

        Raises TypeError for arguments that the block does not have, with the nearest that it has.
        """
        known = [key.key for key in self.keys]
        for name in () if self.fills == "named values" else keywords:
            if name not in known:
                raise TypeError(f"{self.word}() has no {name!r}; {did_you_mean(name, known, ', '.join(known))}")
        try:
            bound = self.signature.bind(*given, **keywords).arguments
        except TypeError as reason:
            raise TypeError(f"{self.word}{self.signature}: {reason}") from None
        if self.fills == "a value":
            values = bound["values"]
            return values[0] if len(values) == 1 else list(values)
        if self.fills == "keys":
            return {**(before or {}), **bound}
        if self.fills == "an entry":
            name = bound.pop("name")
            return {**(before or {}), name: bound}
        pair = bound.get("pair", ())
        if len(pair) not in (0, 2):
            raise TypeError(f"{self.word}() takes a name and a value, or values by keyword")
        return {**(before or {}), **dict([pair] if pair else []), **bound.get("values", {})}

    @property
    def doc(self) -> str:
        """What the word and its arguments are for."""
        arguments = (f"{key.key}: {key.about}" for key in self.keys)
        return "\n".join([f"{self.about[:1].upper()}{self.about[1:]}.", "", *arguments])


def _keys_of(shape: Shape) -> tuple[Key, ...]:
    """Those of a record, or of the record that it may be."""
    if isinstance(shape, RecordShape):
        return shape.fields
    return next(filter(None, map(_keys_of, shape.shapes)), ()) if isinstance(shape, Either) else ()


def _by_keyword(keys: tuple[Key, ...]) -> Iterator[Parameter]:
    """What must be there comes first, by place or keyword; the rest by keyword."""
    for key in sorted(keys, key=lambda key: not key.required):
        kind = Parameter.POSITIONAL_OR_KEYWORD if key.required else Parameter.KEYWORD_ONLY
        yield Parameter(key.key, kind, default=Parameter.empty if key.required else None)


def _word(word: str, block: tuple[str, ...], key: Key) -> BlockWord:
    shape = key.shape
    if isinstance(shape, TableShape):
        if keys := _keys_of(shape.entry):
            return BlockWord(word, block, "an entry", Signature([_NAME, *_by_keyword(keys)]), key.about, keys)
        several = [Parameter("pair", Parameter.VAR_POSITIONAL), Parameter("values", Parameter.VAR_KEYWORD)]
        return BlockWord(word, block, "named values", Signature(several), key.about)
    if isinstance(shape, RecordShape):
        return BlockWord(word, block, "keys", Signature([*_by_keyword(shape.fields)]), key.about, shape.fields)
    return BlockWord(word, block, "a value", Signature([Parameter("values", Parameter.VAR_POSITIONAL)]), key.about)


def block_words() -> dict[str, BlockWord]:
    """All of them, by word."""
    by_word: dict[str, BlockWord] = {}
    for key in MODEL.fields:
        if key.key == "constraints":
            by_word |= {row.key: _word(row.key, (key.key, row.key), row) for row in _keys_of(key.shape)}
        elif key.key != "model":
            word = SINGULAR.get(key.key, key.key)
            by_word[word] = _word(word, (key.key,), key)
    return by_word
