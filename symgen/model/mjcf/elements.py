"""From the elements of an MJCF file to a machine."""

from __future__ import annotations

from dataclasses import replace

from symgen.diagnostics import Mistake
from symgen.model.mjcf.equalities import EqualityReader
from symgen.model.mjcf.settings import MAIN, CompilerSettings, Settings
from symgen.model.mjcf.words import COMPILER, IDLE_SECTIONS, OPTION, REFUSED_SECTIONS, SECTIONS, SWITCHES
from symgen.model.robots.machine import Machine
from symgen.model.robots.numbers import WrittenNumber, read_number
from symgen.model.robots.xml import Element

USUAL_GRAVITY = ("0", "0", "-9.81")


def read_mjcf(root: Element, unread: frozenset[str]) -> tuple[Machine, tuple[Mistake, ...]]:
    """The machine as far as it is understood, and every mistake; `unread` is what the user wants left out, by name."""
    reading = _MjcfReader(unread)
    machine = reading.machine(root)
    return machine, tuple(reading.mistakes)


class _MjcfReader(EqualityReader):
    def machine(self, root: Element) -> Machine:
        if root.tag != "mujoco":
            self.wrong(f"an MJCF file is a `mujoco`, this is a `{root.tag}`", "give an MJCF file", root.span)
            return Machine({})
        self.attributes(root, ("model",))
        self.owner = root.attributes.get("model", "")
        for child in root.children:
            if child.tag in IDLE_SECTIONS:
                self.leave_out(child.tag, "")
            elif child.tag in REFUSED_SECTIONS and (child.children or child.attributes):
                self.refuse(child, *REFUSED_SECTIONS[child.tag])
            elif child.tag not in SECTIONS and child.tag not in REFUSED_SECTIONS:
                self.unknown_child(child, SECTIONS, "mujoco")
        for element in root.all("compiler"):
            self._compiler(element)
        for element in root.all("default"):
            self.read_defaults(element, MAIN)
        gravity = self._gravity(root)
        for element in root.all("worldbody"):
            self.read_world(element)
        for element in root.all("equality"):
            self.read_equalities(element)
        for element in root.all("actuator"):
            self.read_actuators(element)
        joints: dict[str, int] = {}
        for joint in self.joints:
            if joint.name in joints:
                message = f"there is a second joint `{joint.name}` (first in line {joints[joint.name]})"
                self.wrong(message, "remove or rename one of the two", joint.span)
            joints.setdefault(joint.name, joint.span.line)
        left_out = {tag: tuple(names) for tag, names in self.left_out.items()}
        parts = tuple(self.joints), tuple(self.closings), tuple(self.followers), tuple(self.drives)
        return Machine(self.links, *parts, gravity, left_out)

    def _compiler(self, element: Element) -> None:
        self.attributes(element, COMPILER)
        for child in element.children:
            if child.tag != "lengthrange":
                self.unknown_child(child, ("lengthrange",), "compiler")
        settings = Settings(element, dict.fromkeys(element.attributes, element))
        for key in ("balanceinertia", "boundmass", "boundinertia", "alignfree", "settotalmass"):
            if settings.get(key) != "-1":
                self.zero_or(settings, key, "the compiler", "it changes masses or axes", "write out what it makes")
        before: CompilerSettings = self.compiler
        sequence = settings.get("eulerseq", before.sequence)
        if len(sequence) != 3 or not set(sequence.lower()) <= set("xyz"):
            self.wrong(f"`eulerseq` is `{sequence[:20]}`", "give three of x, y, z, X, Y, Z", element.place("eulerseq"))
            sequence = before.sequence
        groups = self.numbers(settings, "inertiagrouprange", "the compiler", 2, 2)
        self.compiler = replace(
            before,
            degrees=settings.get("angle", "degree" if before.degrees else "radian") == "degree",
            sequence=sequence,
            auto_limits=settings.get("autolimits", str(before.auto_limits).lower()) == "true",
            from_geoms=settings.get("inertiafromgeom", before.from_geoms),
            groups=(int(groups[0].value), int(groups[1].value)) if groups else before.groups,
        )

    def _gravity(self, root: Element) -> tuple[WrittenNumber, ...]:
        """Gravity, which is that of the earth along z where nothing is said; fluids are refused."""
        gravity: tuple[WrittenNumber, ...] = ()
        for element in root.all("option"):
            self.attributes(element, OPTION)
            settings = Settings(element, dict.fromkeys(element.attributes, element))
            for key in ("density", "viscosity"):
                self.zero_or(settings, key, "`option`", "a fluid brings forces", "write `forces` in the model file")
            gravity = self.numbers(settings, "gravity", "`option`") or gravity
            for child in element.children:
                for key, value in child.attributes.items() if child.tag == "flag" else ():
                    if key in SWITCHES and value.strip() == "disable":
                        message = f"`{key}` is switched off, and symgen reads what there is"
                        self.wrong(message, "remove this, and what it switches off", child.place(key))
                if child.tag != "flag":
                    self.unknown_child(child, ("flag",), "option")
        if gravity:
            return gravity
        usual = (read_number(text, root.span) for text in USUAL_GRAVITY)
        return tuple(number for number in usual if number is not None)
