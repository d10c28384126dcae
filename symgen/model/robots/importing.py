"""What readers of MJCF and SDF do with a machine that they have understood."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from symgen.diagnostics import Mistake, Notice, printable
from symgen.model.file.scope import Scope
from symgen.model.file.source import MappingNode
from symgen.model.robots.file import Imported, RobotFile
from symgen.model.robots.machine import Machine, named_parts
from symgen.model.robots.machine_blocks import with_machine
from symgen.model.robots.machine_checks import check_machine
from symgen.model.robots.names import read_names
from symgen.model.robots.nodes import ranged_names


def with_described(
    scope: Scope,
    tree: MappingNode,
    given: RobotFile,
    form: str,
    read: tuple[Machine, Iterable[Mistake]],
    about: Mapping[str, str],
) -> Imported:
    """The tree with the machine in it, and notices of what takes no part (`about` says why of some); unchanged where
    something is wrong, which is recorded."""
    machine, mistakes = read
    unchanged = Imported(tree, given.text, given.file)
    scope.mistakes.extend(mistakes)
    if scope.mistakes:
        return unchanged
    names = read_names(scope, given.node, named_parts(form, machine), given.span)
    own = ranged_names(tree)
    ranged = {joint for joint, name in names.coordinates.items() if name in own}
    scope.mistakes.extend(check_machine(machine, ranged))
    if scope.mistakes:
        return unchanged
    for tag, left_out in machine.left_out.items():
        listed = ", ".join(dict.fromkeys(name for name in left_out if name))
        why = f": {about[tag]}" if tag in about else ""
        message = f"`{tag}` of the {form} takes no part{f' ({listed})' if listed else ''}{why}"
        # names in the file are any text
        scope.notices.append(Notice(printable(message), given.span))
    return Imported(with_machine(scope, tree, machine, names, form, given.span), given.text, given.file)
