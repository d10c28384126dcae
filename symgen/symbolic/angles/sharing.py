"""Which sines and cosines are evaluated, and which follow from others by the addition theorem.

Each distinct angle costs a sine/cosine pair; the sum or difference of two angles whose pairs exist anyway costs three
or six products and sums, and so does an angle that another one is turned into by 30, 45, 60 or 90 degrees.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

from symgen.model.kinematics.fixed_angles import sine_of_steps
from symgen.symbolic.angles.angle_forms import angle_form
from symgen.symbolic.graph import Graph
from symgen.symbolic.identity import same_values
from symgen.symbolic.scalar import PI, Scalar
from symgen.symbolic.traverse import topological

# An odd number without a pattern, and a prime modulo which its powers are taken: sums are equal by chance hardly
# ever.
BASE, MODULUS = 0x9E3779B97F4A7C15, 2**61 - 1


def share_angles(graph: Graph, outputs: Sequence[Scalar], evaluated: Sequence[Scalar] = ()) -> list[Scalar]:
    """The outputs with derivable sines and cosines replaced by products of the evaluated ones.

    The pairs of the angles in `evaluated` exist already.
    """
    needed = [angle for angle in angles_of(outputs) if angle not in evaluated]
    kept = _EvaluatedAngles()
    for angle in evaluated:
        kept.add(angle, angle_form(angle))
    image: dict[Scalar, Scalar] = {}
    for angle in needed:
        form = angle_form(angle)
        turned = kept.as_turned(graph, form)
        if turned is not None:
            _turn(graph, image, angle, *turned)
            kept.add(angle, form)
            continue
        parts = kept.as_sum(form)
        kept.add(angle, form)
        if parts is None:
            continue
        (a, sign_a), (b, sign_b) = parts
        sines = [_value(graph, image, "sin", a), _value(graph, image, "sin", b)]
        cosines = [_value(graph, image, "cos", a), _value(graph, image, "cos", b)]
        # as they stand: the constructors would fold these products and sums back into the angle
        crossed = [graph.raw("mul", (sines[0], cosines[1])), graph.raw("mul", (cosines[0], sines[1]))]
        level = [graph.raw("mul", (cosines[0], cosines[1])), graph.raw("mul", (sines[0], sines[1]))]
        image[graph.trig("sin", angle)] = _signed(graph, sign_a, crossed[0], sign_b, crossed[1])
        image[graph.trig("cos", angle)] = _signed(graph, 1, level[0], -sign_a * sign_b, level[1])
    # an angle that is known may follow from itself, turned by nothing
    image = {node: value for node, value in image.items() if value is not node}
    if not image:
        return list(outputs)
    shared = _replace(graph, outputs, image)
    same_values("sharing sines and cosines", outputs, shared)
    return shared


def angles_of(outputs: Sequence[Scalar]) -> list[Scalar]:
    """The arguments of all sines and cosines, simple ones first, but none before those whose sines it is made of."""
    nested: dict[Scalar, int] = {}
    arguments: dict[Scalar, int] = {}
    for node in topological(outputs):
        nested[node] = max((nested[x] for x in node.args), default=0)
        if node.op in ("sin", "cos"):
            arguments[node.args[0]] = nested[node]
            nested[node] += 1
    forms = {argument: angle_form(argument) for argument in arguments}
    return sorted(
        arguments, key=lambda a: (arguments[a], len(forms[a]), sum(map(abs, forms[a].values())), a.serial)
    )


class _EvaluatedAngles:
    """Angles whose pairs exist, in the order in which they are tried.

    A sum over the leaves, linear like the form, tells nearly always that a difference is none of them: the pairs of
    angles are as many as the square of a chain's length.
    """

    def __init__(self) -> None:
        self._angles: list[tuple[Scalar, dict[Scalar, int], int]] = []
        self._by_form: dict[tuple[tuple[int, int], ...], Scalar] = {}
        self._sums: set[int] = set()
        self._by_rest: dict[tuple[tuple[int, int], ...], tuple[Scalar, Fraction]] = {}

    def add(self, angle: Scalar, form: dict[Scalar, int]) -> None:
        """One more angle."""
        known = _linear(form)
        self._angles.append((angle, form, known))
        self._by_form[_key(form)] = angle
        self._sums.add(known)
        shift, rest = _split(form)
        self._by_rest.setdefault(_key(rest), (angle, shift))

    def as_turned(self, graph: Graph, form: dict[Scalar, int]) -> tuple[Scalar, int, Scalar, Scalar] | None:
        """A kept angle, its sign, and sine and cosine of the fixed angle that is added to make the form."""
        shift, rest = _split(form)
        for sign in (1, -1):
            kept_angle = self._by_rest.get(_key({leaf: sign * count for leaf, count in rest.items()}))
            pair = None if kept_angle is None else _fixed_pair(graph, shift - sign * kept_angle[1])
            if kept_angle is not None and pair is not None:
                return kept_angle[0], sign, *pair
        return None

    def as_sum(self, form: dict[Scalar, int]) -> tuple[tuple[Scalar, int], tuple[Scalar, int]] | None:
        """The first two angles, each with a sign, whose sum is the form."""
        wanted, sums = _linear(form), self._sums
        for angle, known, size in self._angles:
            for sign in (1, -1):
                left = wanted - sign * size
                if left not in sums and -left not in sums:
                    continue
                rest = {leaf: form.get(leaf, 0) - sign * known.get(leaf, 0) for leaf in (*form, *known)}
                for rest_sign in (1, -1):
                    key = _key({leaf: rest_sign * count for leaf, count in rest.items() if count})
                    if key in self._by_form:
                        return (angle, sign), (self._by_form[key], rest_sign)
        return None


def _split(form: dict[Scalar, int]) -> tuple[Fraction, dict[Scalar, int]]:
    """The fixed part of an angle, and the rest of its form."""
    shift = sum((leaf.constant * count for leaf, count in form.items() if leaf.constant is not None), Fraction(0))
    return shift, {leaf: count for leaf, count in form.items() if leaf.constant is None}


def _fixed_pair(graph: Graph, angle: Fraction) -> tuple[Scalar, Scalar] | None:
    """Sine and cosine of a fixed angle by one square root at most, or None."""
    steps = angle * 12 / PI
    if steps.denominator != 1:
        return None
    sines = [sine_of_steps(int(steps) + quarter) for quarter in (0, 6)]
    values = [None if s is None else graph.const(s[0]) * graph.function("sqrt", (graph.const(s[1]),)) for s in sines]
    sine, cosine = values
    return None if sine is None or cosine is None else (sine, cosine)


def _turn(
    graph: Graph, image: dict[Scalar, Scalar], angle: Scalar, kept: Scalar, sign: int, sine: Scalar, cosine: Scalar
) -> None:
    """The pair of sign * kept + a fixed angle, from the pair of the kept one."""
    known_sine, known_cosine = _value(graph, image, "sin", kept), _value(graph, image, "cos", kept)
    if sign < 0:
        known_sine = graph.neg(known_sine)
    sines = graph.trig("sin", angle), graph.trig("cos", angle)
    image[sines[0]] = _raw_sum(graph, known_sine, cosine, known_cosine, sine)
    image[sines[1]] = _raw_sum(graph, known_cosine, cosine, graph.neg(known_sine), sine)


def _raw_sum(graph: Graph, a: Scalar, x: Scalar, b: Scalar, y: Scalar) -> Scalar:
    """a x + b y as it stands: the constructors would find the angle again."""
    total = graph.zero
    for value, factor in ((a, x), (b, y)):
        negative = (value.op == "neg") != (factor.op == "neg" or (factor.constant is not None and factor.constant < 0))
        value = value.args[0] if value.op == "neg" else value
        factor = factor if not (factor.op == "neg" or (factor.constant or 0) < 0) else graph.neg(factor)
        if factor.is_zero:
            continue
        term = value if factor.is_one else graph.raw("mul", (value, factor))
        if total.is_zero:
            total = graph.raw("neg", (term,)) if negative else term
        elif total.op == "neg" and not negative:
            total = graph.raw("sub", (term, total.args[0]))
        else:
            total = graph.raw("sub" if negative else "add", (total, term))
    return total


def _linear(form: dict[Scalar, int]) -> int:
    """sum of count times a number of each leaf that hardly any other combination shares."""
    return sum(count * pow(BASE, leaf.serial + 1, MODULUS) for leaf, count in form.items())


def _key(form: dict[Scalar, int]) -> tuple[tuple[int, int], ...]:
    return tuple(sorted((leaf.serial, count) for leaf, count in form.items()))


def _value(graph: Graph, image: dict[Scalar, Scalar], name: str, angle: Scalar) -> Scalar:
    node = graph.trig(name, angle)
    return image.get(node, node)


def _signed(graph: Graph, sign_a: int, a: Scalar, sign_b: int, b: Scalar) -> Scalar:
    """sign_a a + sign_b b as it stands."""
    if sign_a > 0:
        return graph.raw("add" if sign_b > 0 else "sub", (a, b))
    return graph.raw("sub", (b, a)) if sign_b > 0 else graph.raw("neg", (graph.raw("add", (a, b)),))


def _replace(graph: Graph, outputs: Sequence[Scalar], image: Mapping[Scalar, Scalar]) -> list[Scalar]:
    """The outputs with images in the place of nodes, in what images are made of, too.

    An angle may be computed from sines of others.  Where its own sine kept the angle as it was before these were
    replaced, both would be computed, and differ by their roundings.
    """
    done: dict[Scalar, Scalar] = {}
    stack = list(reversed(outputs))
    while stack:
        node = stack[-1]
        needed = (image[node],) if node in image else node.args
        missing = [x for x in reversed(needed) if x not in done]
        if node not in done and missing:
            stack += missing
            continue
        stack.pop()
        if node in image:
            done[node] = done[image[node]]
        elif node not in done:
            args = tuple(done[argument] for argument in node.args)
            # as it stands: the constructors would find the angle again
            done[node] = node if args == node.args else graph.raw(node.op, args, node.payload)
    return [done[output] for output in outputs]
