"""A model file as a Model, or all its mistakes at once."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from symgen.diagnostics import Mistake, ModelError, Span
from symgen.model.file.attempts import attempted_names
from symgen.model.file.misplaced import without_misplaced
from symgen.model.file.reading import key_span
from symgen.model.file.schema import MODEL
from symgen.model.file.scope import Scope
from symgen.model.file.shape import check_shape
from symgen.model.file.source import MappingNode, read_tree
from symgen.model.mechanism import DrawnSolid
from symgen.model.model import Model
from symgen.model.resolve import resolve

if TYPE_CHECKING:
    from symgen.model.robots.file import Imported

# Blocks that name a robot description beside the model file.
DESCRIPTIONS = ("urdf", "mjcf", "sdf")


def load_model(path: Path) -> Model:
    """The model in the file at `path`; raises ModelError with every mistake, OSError where it cannot be read."""
    data = path.read_bytes()
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        mistake = Mistake("the file is not text in UTF-8", "save it as UTF-8", Span(line, 1, 2))
        raise ModelError(str(path), data.decode("utf-8", "replace"), (mistake,)) from None
    return load_text(text, str(path))


def load_text(text: str, file: str) -> Model:
    """The model in `text`; `file` is its name in messages, and a robot description is looked for in its folder.

    Raises ModelError with every mistake.
    """
    tree, mistakes = read_tree(text)
    if tree is None:
        raise ModelError(file, text, mistakes)
    rest, misplaced = without_misplaced(tree)
    all_mistakes = [*mistakes, *misplaced, *check_shape(MODEL, rest, "the model")]
    scope = Scope(mistakes=all_mistakes, attempted=attempted_names(tree, all_mistakes))
    tree = rest
    beside: dict[str, str] = {}
    solids: tuple[DrawnSolid, ...] = ()
    described = [key for key in DESCRIPTIONS if tree.get(key) is not None]
    if described:
        for further in described[1:]:
            message = f"`{described[0]}` and `{further}` both describe the robot"
            scope.wrong(message, "keep one of them", key_span(tree, further))
        if scope.mistakes:
            raise ModelError(file, text, tuple(scope.mistakes))
        imported = _import(described[0], scope, tree, Path(file).parent)
        tree, beside, solids = imported.tree, {imported.file: imported.text}, imported.solids
        # without the robot every name of it would be unknown
        if scope.mistakes:
            raise ModelError(file, text, tuple(scope.mistakes), beside)
    model = resolve(scope, tree, "".join((text, *beside.values())))
    if scope.mistakes:
        raise ModelError(file, text, tuple(scope.mistakes), beside)
    return replace(model, notices=tuple(scope.notices), picture=replace(model.picture, solids=solids))


def _import(key: str, scope: Scope, tree: MappingNode, folder: Path) -> Imported:
    """The tree with what the robot description holds; its reader is loaded where it is used only."""
    if key == "urdf":
        from symgen.model.urdf.read import import_robot

        return import_robot(scope, tree, folder)
    if key == "mjcf":
        from symgen.model.mjcf.read import import_mjcf

        return import_mjcf(scope, tree, folder)
    from symgen.model.sdf.read import import_sdf

    return import_sdf(scope, tree, folder)
