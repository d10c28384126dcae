"""The text of a robot description, which must lie in the folder of the model or below it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from symgen.diagnostics import Mistake, Span
from symgen.model.file.reading import items, key_span, member, text_of
from symgen.model.file.scope import Scope
from symgen.model.file.source import MAXIMUM_CHARACTERS, MappingNode, Node, ScalarNode
from symgen.model.mechanism import DrawnSolid
from symgen.model.robots.xml import Element, parse_xml


@dataclass(frozen=True, slots=True)
class Imported:
    """The tree with the robot in it; the text of its file and that file's name in messages; what links look like."""

    tree: MappingNode
    text: str
    file: str
    solids: tuple[DrawnSolid, ...] = ()


@dataclass(frozen=True, slots=True)
class RobotFile:
    """What a block of the model file says about a robot description, and its XML where it could be read."""

    node: Node | None
    span: Span
    text: str
    file: str
    root: Element | None

    @property
    def unread(self) -> frozenset[str]:
        """The elements and attributes that the user wants left out."""
        return frozenset(text_of(item) or "" for item in items(member(self.node, "leave_out")))


def read_description(scope: Scope, tree: MappingNode, folder: Path, key: str) -> RobotFile:
    """The file that the block `key` names; what is wrong with it is recorded, and there is no root then."""
    node = tree.get(key)
    name = node if isinstance(node, ScalarNode) else member(node, "file")
    span = key_span(tree, key) or tree.span
    if not isinstance(name, ScalarNode):
        return RobotFile(node, span, "", "", None)
    file = str(folder / name.value)
    text = _text(scope, name, folder)
    if text is None:
        return RobotFile(node, span, "", file, None)
    root = parse_xml(text, file, key.upper())
    if isinstance(root, Mistake):
        scope.mistakes.append(root)
        return RobotFile(node, span, text, file, None)
    return RobotFile(node, span, text, file, root)


def _text(scope: Scope, node: ScalarNode, folder: Path) -> str | None:
    name = text_of(node) or ""
    parts = PurePosixPath(name).parts
    if not name or name.startswith("/") or ".." in parts or "\\" in name or ":" in name or not name.isprintable():
        message = f"`{name[:60]}` is no plain path below the folder of the model file"
        scope.wrong(message, "copy the robot description beside the model file, and write its name", node.span)
        return None
    path = folder / name
    try:
        if not path.resolve().is_relative_to(folder.resolve()):
            message = f"`{name}` is a link that leads out of the folder of the model file"
            scope.wrong(message, "copy the robot description beside the model file", node.span)
            return None
        if not path.is_file():
            scope.wrong(f"there is no file `{name}`", "the path starts at the folder of the model file", node.span)
            return None
        with path.open("rb") as stream:
            data = stream.read(4 * MAXIMUM_CHARACTERS + 1)
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        scope.wrong(f"`{name}` is not text in UTF-8 (line {line})", "save it as UTF-8", node.span)
    except (OSError, ValueError):
        scope.wrong(f"`{name}` cannot be read", "check the permissions of the file", node.span)
    return None
