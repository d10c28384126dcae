"""Frames as links: which frames are one rigid link, and the places at which others hang on it."""

from __future__ import annotations

from collections.abc import Iterable

from symgen.drawing.pose import MachinePose, Place
from symgen.model.expressions.walk import evaluate
from symgen.model.mechanism import WORLD


class LinkPlaces:
    """The places of each link by the name of its first frame, in the world; those of the world are `places[WORLD]`.

    `root` has the first frame of the link that a frame belongs to.
    """

    def __init__(self, pose: MachinePose) -> None:
        self._pose = pose
        self.root: dict[str, str] = {WORLD: WORLD}
        self.places: dict[str, list[Place]] = {}
        joints = {joint.frame: joint for joint in pose.joints}
        for frame in pose.mechanism.frames:
            fixed = joints[frame.name].kind == "fixed"
            self.root[frame.name] = self.root[frame.parent] if fixed else frame.name
        for frame in pose.mechanism.frames:
            joint = joints[frame.name]
            if joint.kind not in ("fixed", "free"):
                self._add(self.root[frame.parent], joint.foot)
                self._add(self.root[frame.name], joint.place)
            elif joint.kind == "fixed" and self.root[frame.name] != WORLD:
                self._add(self.root[frame.name], joint.place)
        self._add_ends()
        self._add_bodies()

    def _add_ends(self) -> None:
        """Points, and frames at which rods and the like end."""
        pose = self._pose
        ends = {end for tie in pose.mechanism.ties for end in tie.ends}
        for point in pose.mechanism.points:
            # points that energies speak of may move in the world itself, which carries none of them then
            carried = point.frame != WORLD or pose.is_still(point.name)
            if carried and (point.frame == point.carrier or point.name in ends):
                self._add(self.root[point.frame], pose.places[point.name])
        for frame in pose.mechanism.frames:
            if frame.name in ends:
                self._add(self.root[frame.name], pose.places[frame.name])

    def _add_bodies(self) -> None:
        """Centres of mass of links that have one place only."""
        pose = self._pose
        for body in pose.mechanism.bodies:
            root = self.root[body.frame]
            if root != WORLD and len(self.places.get(root, [])) < 2:
                x, y, z = (evaluate(entry, pose.parameters) for entry in body.com)
                self._add(root, pose.in_world(body.frame, (x, y, z)))

    def _add(self, frame: str, place: Place) -> None:
        known = self.places.setdefault(frame, [])
        if not self.is_among(place, known):
            known.append(place)

    def is_among(self, place: Place, others: Iterable[Place]) -> bool:
        """Whether a place is one of others."""
        return any(self._pose.is_same(place, other) for other in others)
