"""`sdf: robot.sdf`: the file beside the model, read with suspicion, as blocks of the model language."""

from __future__ import annotations

from pathlib import Path

from symgen.diagnostics import Notice, printable
from symgen.model.file.reading import entries, member, text_of
from symgen.model.file.scope import Scope
from symgen.model.file.source import MappingNode
from symgen.model.robots.file import Imported, read_description
from symgen.model.robots.importing import with_described
from symgen.model.robots.names import plain_name
from symgen.model.robots.nodes import is_placed
from symgen.model.sdf.elements import read_sdf

ABOUT = {
    "effort": "limits of inputs stand under `allocation` of the model file",
    "limit": "the joint closes a loop and has no coordinate",
    "static": "models that stand still",
    "physics": "it is for a simulator",
}


def import_sdf(scope: Scope, tree: MappingNode, folder: Path) -> Imported:
    """The model that `sdf` names, in the tree; what is wrong with it is recorded, and the tree then stays as it is."""
    given = read_description(scope, tree, folder, "sdf")
    if given.root is None:
        return Imported(tree, given.text, given.file)
    renamed = {text_of(value): key.value for key, value in entries(member(given.node, "frames"))}
    machine, mistakes = read_sdf(
        given.root, given.unread, lambda link: is_placed(tree, renamed.get(link, plain_name(link)))
    )
    imported = with_described(scope, tree, given, "SDF", (machine, mistakes), ABOUT)
    if scope.mistakes:
        return imported
    closing = ", ".join(closing.name for closing in machine.closings)
    if closing:
        message = f"joints of the SDF beyond a tree close loops, and have no coordinates ({closing})"
        scope.notices.append(Notice(printable(message), given.span))
    for joint in machine.joints:
        if joint.kind == "floating":
            message = f"the link `{joint.child}` of the SDF is joined to nothing: it moves freely, as `{joint.name}`; "
            held = f"to hold it still write `frames: {{{plain_name(joint.child)}: {{}}}}`"
            scope.notices.append(Notice(printable(message + held), joint.span))
    return imported
