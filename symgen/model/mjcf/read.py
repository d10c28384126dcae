"""`mjcf: robot.xml`: the file beside the model, read with suspicion, as blocks of the model language."""

from __future__ import annotations

from pathlib import Path

from symgen.diagnostics import Mistake
from symgen.model.file.scope import Scope
from symgen.model.file.source import MappingNode
from symgen.model.mjcf.elements import read_mjcf
from symgen.model.robots.file import Imported, read_description
from symgen.model.robots.importing import with_described

ABOUT = {
    "asset": "pictures and meshes",
    "contact": "bodies do not touch each other in a model",
    "range": "joints of balls are not limited",
    "actuatorfrcrange": "limits of inputs stand under `allocation` of the model file",
    "ctrlrange": "limits of inputs stand under `allocation` of the model file",
    "forcerange": "limits of inputs stand under `allocation` of the model file",
}


def import_mjcf(scope: Scope, tree: MappingNode, folder: Path) -> Imported:
    """The machine that `mjcf` names, in the tree; what is wrong with it is recorded, and the tree then stays."""
    given = read_description(scope, tree, folder, "mjcf")
    if given.root is None:
        return Imported(tree, given.text, given.file)
    machine, mistakes = read_mjcf(given.root, given.unread)
    if not mistakes and not machine.joints:
        mistakes = (Mistake("the file has no bodies", "give an MJCF file with bodies and joints", given.root.span),)
    return with_described(scope, tree, given, "MJCF", (machine, mistakes), ABOUT)
