"""Reading what identification takes for known, and which gains of drives it estimates."""

from __future__ import annotations

from collections.abc import Sequence

from symgen.model.expressions.names import did_you_mean
from symgen.model.file.reading import items, member, text_of
from symgen.model.file.scope import Scope
from symgen.model.file.source import MappingNode, Node
from symgen.model.identify_choice import IdentifyChoice
from symgen.model.model import Parameter


def read_identify(scope: Scope, tree: MappingNode, parameters: Sequence[Parameter]) -> IdentifyChoice | None:
    """The parameters under `identify`; None where the file has no such block."""
    node = tree.get("identify")
    if node is None:
        return None
    names = [p.name for p in parameters]
    geometry, fixed, gains = (_named(scope, member(node, key), key, names) for key in ("geometry", "fixed", "gains"))
    is_said = member(node, "gains") is None or any(member(node, key) is not None for key in ("geometry", "fixed"))
    return IdentifyChoice(geometry, fixed, gains, is_said)


def _named(scope: Scope, node: Node | None, key: str, names: Sequence[str]) -> tuple[str, ...]:
    chosen = []
    for item in items(node):
        name = text_of(item)
        if name is None:
            continue
        if name in names:
            chosen.append(name)
        else:
            remedy = did_you_mean(name, names, "name parameters of the file")
            scope.wrong_about(name, f"`{name}` under `{key}` of `identify` is no parameter", remedy, item.span)
    return tuple(chosen)
