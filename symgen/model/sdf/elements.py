"""From the elements of an SDF file to a machine."""

from __future__ import annotations

from collections.abc import Callable

from symgen.diagnostics import Mistake
from symgen.model.mechanism import WORLD
from symgen.model.robots.machine import Machine
from symgen.model.robots.numbers import WrittenNumber, read_number
from symgen.model.robots.reader import MAXIMUM_LINKS
from symgen.model.robots.xml import Element
from symgen.model.sdf.joints import PartReader
from symgen.model.sdf.poses import MODEL, Posed, Poses
from symgen.model.sdf.tree import made_tree
from symgen.model.sdf.words import (
    MODEL_ATTRIBUTES,
    MODEL_IDLE,
    MODEL_READ,
    MODEL_REFUSED,
    WORLD_IDLE,
    WORLD_REFUSED,
)

# In a world that does not say otherwise.
USUAL_GRAVITY = ("0", "0", "-9.8")


def read_sdf(
    root: Element, unread: frozenset[str], held: Callable[[str], bool]
) -> tuple[Machine, tuple[Mistake, ...]]:
    """The machine as far as it is understood, and every mistake; `unread` is what the user wants left out, by name, and
    `held` tells which links the model file places itself."""
    reading = _SdfReader(unread, held)
    machine = reading.machine(root)
    return machine, tuple(reading.mistakes)


class _SdfReader(PartReader):
    def __init__(self, unread: frozenset[str], held: Callable[[str], bool]) -> None:
        super().__init__(unread)
        self._held = held

    def machine(self, root: Element) -> Machine:
        if root.tag != "sdf":
            self.wrong(f"an SDF file is an `sdf`, this is a `{root.tag}`", "give an SDF file", root.span)
            return Machine({})
        self.attributes(root, ("version",))
        self.parts(root, ("world", "model"), ("light",), {"actor": WORLD_REFUSED["actor"]})
        models = list(root.all("model"))
        gravity: tuple[WrittenNumber, ...] = ()
        world = self.only(root, "world")
        if world is not None:
            self.attributes(world, ("name",))
            self.parts(world, ("model", "gravity"), WORLD_IDLE, WORLD_REFUSED)
            models += world.all("model")
            gravity = self._gravity(world)
        moving = []
        for model in models:
            if self.is_true(model, "static"):
                self.leave_out("static", model.attributes.get("name", ""))
            else:
                moving.append(model)
        if len(moving) == 1:
            return self._model(moving[0], gravity)
        if not moving:
            self.wrong("the file has no model that moves", "give an SDF file with links and joints", root.span)
        for model in moving[1:]:
            self.wrong("a second model that moves is not read", "write all into one model", model.place("name"))
        return Machine({})

    def _gravity(self, world: Element) -> tuple[WrittenNumber, ...]:
        written = self.only(world, "gravity")
        if written is not None:
            return self.values(written, "`gravity`", 3)
        usual = (read_number(text, world.span) for text in USUAL_GRAVITY)
        return tuple(number for number in usual if number is not None)

    def _model(self, model: Element, gravity: tuple[WrittenNumber, ...]) -> Machine:
        self.owner = model.attributes.get("name", "")
        self.attributes(model, MODEL_ATTRIBUTES)
        self.parts(model, MODEL_READ, MODEL_IDLE, MODEL_REFUSED)
        if len(model.all("link")) > MAXIMUM_LINKS or len(model.all("joint")) > MAXIMUM_LINKS:
            message = f"the model has more than {MAXIMUM_LINKS} links or joints"
            self.wrong(message, "import the part of it that moves", model.span)
            return Machine({})
        if not model.all("link"):
            self.wrong("the model has no links", "give an SDF file with links and joints", model.span)
            return Machine({})
        pose = self.only(model, "pose")
        if pose is not None and pose.attributes.get("relative_to", "world").strip() != "world":
            self.wrong("the model stands relative to something else", "give its pose in the world", pose.span)
        known = self._posed(model)
        links = {link.name: link for link in map(self.link, model.all("link"))}
        canonical = model.attributes.get("canonical_link", "").strip() or next(iter(links))
        poses = Poses(self, self.pose(pose, "the model"), known, canonical)
        read = [self.joint(element, poses) for element in model.all("joint")]
        joints = [joint for joint in read if joint is not None]
        places = {name: poses.place(name, link.span) for name, link in links.items()}
        if self.mistakes:
            return Machine({})
        held = {name for name in links if self._held(name)}
        made = made_tree(self, links, places, joints, held)
        self._massless(made)
        left_out = {tag: tuple(names) for tag, names in self.left_out.items()}
        return Machine(
            made.links, made.joints, made.closings, made.followers, (), gravity, left_out, made.placed
        )

    def _massless(self, made: Machine) -> None:
        """Links that move and have no mass here, where other readers of SDF take one."""
        still = {WORLD, *made.placed}
        for joint in made.joints:
            link = made.links[joint.child]
            if joint.kind == "fixed" and joint.parent in still:
                still.add(link.name)
            elif not link.solids and not link.stands_between:
                remedy = "write <inertial> with <mass> and <inertia>, of 0 where it has no mass"
                message = f"the link `{link.name}` moves and has no `inertial`, where SDF takes 1 kg for it"
                self.owner = link.name
                self.wrong(message, remedy, link.span)

    def _posed(self, model: Element) -> dict[str, Posed]:
        """Everything with a pose by its name, each of which stands once."""
        known: dict[str, Posed] = {}
        for element in model.children:
            if element.tag not in ("link", "joint", "frame"):
                continue
            self.owner = element.attributes.get("name", "").strip()
            name = self.text(element, "name", f"the {element.tag}")
            if element.tag == "link":
                posed = self.posed(element, MODEL, name)
            elif element.tag == "joint":
                child = self.only(element, "child")
                end = "" if child is None else child.text
                posed = self.posed(element, end, end)
            else:
                self.attributes(element, ("name", "attached_to"))
                self.parts(element, ("pose",))
                other = element.attributes.get("attached_to", "").strip() or MODEL
                posed = self.posed(element, other, other)
            if name in known:
                self.twice(element.tag, element, known[name].span)
            known.setdefault(name, posed)
        return known
