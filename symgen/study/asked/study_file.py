"""A study file: model, ranges, sample, states and what is shown, each with its place."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from symgen.diagnostics import ModelError, Span, printable
from symgen.model.file.constants import constant, whole_number
from symgen.model.file.reading import entries, items, member, text_of
from symgen.model.file.scope import Scope
from symgen.model.file.shape import (
    Either,
    ExpressionShape,
    Key,
    Listing,
    RecordShape,
    TableShape,
    Text,
    Word,
    check_shape,
)
from symgen.model.file.source import MappingNode, Node, ScalarNode, read_tree
from symgen.study.asked.request import GRID, SAMPLES, SHOWN, AskedName, StudyAxis, StudyMistakes, StudyRequest
from symgen.study.sizing.catalogue import Motor, read_catalogue

# Of samples and of grids along an axis: more would not end.
MOST_VALUES = 10**12
# Of seeds: what generators of random numbers take in one word.
LARGEST_SEED = 2**32 - 1
MODEL_FILES = (".yaml", ".yml")
_NUMBER = ExpressionShape()
_RANGES = TableShape(Listing(_NUMBER, 2, 3), 1)
STUDY = RecordShape(
    "the study",
    (
        Key("model", Text(), "the model file, seen from this one", required=True),
        Key("over", _RANGES, "parameters, coordinates or the task as name: [first, last, count]", required=True),
        Key("sample", Word(SAMPLES), "how points are taken from the ranges (grid)"),
        Key("count", _NUMBER, "how many points a sample has that is no grid"),
        Key("seed", _NUMBER, "which of the samples it is (0)"),
        Key("along", Either((Word(), _RANGES)), "a path of the model, or ranges; its states are reduced at each point"),
        Key("show", Listing(Word(SHOWN), 1), "quantities of interest", required=True),
        Key("size", Text(), "a catalogue of motors for the drives, seen from this file"),
        Key("quantiles", Listing(_NUMBER, 1), "levels between 0 and 1 along the states of a point"),
    ),
)  # fmt: skip


def is_study(text: str) -> bool:
    """Whether a file is a study, not a model: it varies something."""
    tree, _ = read_tree(text)
    return tree is not None and tree.get("over") is not None


def read_study(path: Path, text: str) -> tuple[StudyRequest, StudyMistakes]:
    """The request in the text of the file at `path`; raises ModelError where it has not the shape of a study."""
    tree, mistakes = read_tree(text)
    if tree is None:
        raise ModelError(str(path), text, mistakes)
    scope = Scope(mistakes=[*mistakes, *check_shape(STUDY, tree, "the study")], attempted=set())
    request = _request(scope, path, tree)
    if scope.mistakes:
        raise ModelError(str(path), text, tuple(scope.mistakes))
    return request, StudyMistakes(str(path), text)


def _request(scope: Scope, path: Path, tree: MappingNode) -> StudyRequest:
    along = tree.get("along")
    shown = (node for node in items(tree.get("show")) if isinstance(node, ScalarNode))
    sample = tree.get("sample")
    return StudyRequest(
        model=_model(scope, path, tree.get("model")),
        over=tuple(_axes(scope, tree.get("over"))),
        show=tuple(AskedName(node.value, node.span) for node in shown),
        sample=text_of(sample) or GRID,
        count=_whole(scope, tree, "count", 1, MOST_VALUES),
        seed=_whole(scope, tree, "seed", 0, LARGEST_SEED) or 0,
        path=AskedName(along.value, along.span) if isinstance(along, ScalarNode) else None,
        along=tuple(_axes(scope, along)),
        quantiles=tuple(_numbers(scope, items(tree.get("quantiles")), "a level of `quantiles`")),
        quantiles_span=_span(tree.get("quantiles")),
        sample_span=_span(tree.get("count") or sample),
        motors=_motors(scope, path, tree.get("size")),
        motors_span=_span(tree.get("size")),
    )


def _model(scope: Scope, path: Path, node: Node | None) -> Path:
    """The file of the model: a model file, in a place seen from the study."""
    name = text_of(node) or ""
    model = path.parent / name
    if name and (Path(name).is_absolute() or model.suffix not in MODEL_FILES or not model.is_file()):
        message = f"there is no model file {printable(name)} seen from this one"
        scope.wrong(message, "write a relative path that ends in .yaml", _span(node))
    return model


def _motors(scope: Scope, path: Path, node: Node | None) -> tuple[Motor, ...]:
    """The motors of the catalogue, a file in a place seen from the study."""
    name = text_of(node)
    if name is None:
        return ()
    catalogue = path.parent / name
    if Path(name).is_absolute() or not catalogue.is_file():
        message = f"there is no catalogue {printable(name)} seen from this file"
        scope.wrong(message, "write a relative path of a CSV file", _span(node))
        return ()
    return read_catalogue(catalogue)


def _axes(scope: Scope, node: Node | None) -> Iterable[StudyAxis]:
    for key, values in entries(node):
        numbers = _numbers(scope, items(values)[:2], f"the range of `{key.value}`")
        count = _member_at(values, 2)
        number = whole_number(scope, count, f"the number of values of `{key.value}`", 1, MOST_VALUES) if count else None
        if len(numbers) == 2:
            yield StudyAxis(key.value, numbers[0], numbers[1], number, key.span)


def _member_at(node: Node | None, place: int) -> Node | None:
    """An entry of a list, where it has that many."""
    listed = items(node)
    return listed[place] if place < len(listed) else None


def _numbers(scope: Scope, nodes: Iterable[Node], what: str) -> list[float]:
    numbers = []
    for node in nodes:
        value = constant(scope, node, what)
        try:
            numbers += [] if value is None else [float(value)]
        except OverflowError:
            scope.wrong(f"{what} is beyond the range of doubles", "write a smaller number", _span(node))
    return numbers


def _whole(scope: Scope, tree: MappingNode, key: str, least: int, most: int) -> int | None:
    node = member(tree, key)
    return None if node is None else whole_number(scope, node, f"`{key}`", least, most)


def _span(node: Node | None) -> Span | None:
    return None if node is None else node.span

