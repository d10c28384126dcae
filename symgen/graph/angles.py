"""Which sines and cosines are evaluated, and which follow from others by the addition theorem.

Each distinct angle costs a sine/cosine pair; the sum or difference of two angles whose pairs exist anyway costs three
or six products and sums.
"""

from __future__ import annotations

from collections.abc import Sequence

from symgen.graph.scalar import Graph, Scalar
from symgen.graph.traverse import topological


def share_angles(graph: Graph, outputs: Sequence[Scalar], evaluated: Sequence[Scalar] = ()) -> list[Scalar]:
    """The outputs with derivable sines and cosines replaced by products of the evaluated ones.

    The pairs of the angles in `evaluated` exist already.
    """
    needed = [angle for angle in angles_of(outputs) if angle not in evaluated]
    kept = [(angle, graph.angle_form(angle)) for angle in evaluated]
    image: dict[Scalar, Scalar] = {}
    for angle in needed:
        form = graph.angle_form(angle)
        parts = _as_sum(form, kept)
        kept.append((angle, form))
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
    if not image:
        return list(outputs)
    return _replace(graph, outputs, image)


def angles_of(outputs: Sequence[Scalar]) -> list[Scalar]:
    """The arguments of all sines and cosines, simple ones first."""
    arguments = {node.args[0] for node in topological(outputs) if node.op in ("sin", "cos")}
    graph = next(iter(arguments)).graph if arguments else None
    if graph is None:
        return []
    forms = {argument: graph.angle_form(argument) for argument in arguments}
    return sorted(arguments, key=lambda a: (len(forms[a]), sum(map(abs, forms[a].values())), a.serial))


def _as_sum(
    form: dict[Scalar, int], kept: Sequence[tuple[Scalar, dict[Scalar, int]]]
) -> tuple[tuple[Scalar, int], tuple[Scalar, int]] | None:
    by_form = {_key(known): angle for angle, known in kept}
    for angle, known in kept:
        for sign in (1, -1):
            rest = {leaf: form.get(leaf, 0) - sign * known.get(leaf, 0) for leaf in (*form, *known)}
            rest = {leaf: count for leaf, count in rest.items() if count}
            for rest_sign in (1, -1):
                key = _key({leaf: rest_sign * count for leaf, count in rest.items()})
                if key in by_form:
                    return (angle, sign), (by_form[key], rest_sign)
    return None


def _key(form: dict[Scalar, int]) -> tuple[tuple[int, int], ...]:
    return tuple(sorted((leaf.serial, count) for leaf, count in form.items()))


def _value(graph: Graph, image: dict[Scalar, Scalar], name: str, angle: Scalar) -> Scalar:
    node = graph.trig(name, angle)
    return image.get(node, node)


def _signed(graph: Graph, sign_a: int, a: Scalar, sign_b: int, b: Scalar) -> Scalar:
    """sign_a a + sign_b b as it stands; at least one sign is positive, since an angle leads with a positive leaf."""
    if sign_a > 0:
        return graph.raw("add" if sign_b > 0 else "sub", (a, b))
    return graph.raw("sub", (b, a))


def _replace(graph: Graph, outputs: Sequence[Scalar], image: dict[Scalar, Scalar]) -> list[Scalar]:
    done: dict[Scalar, Scalar] = dict(image)
    for node in topological([*outputs, *image.values()]):
        if node in done:
            continue
        args = tuple(done.get(argument, argument) for argument in node.args)
        if args == node.args:
            done[node] = node
        else:
            # as it stands: the constructors would find the angle again
            done[node] = graph.raw(node.op, args, node.payload)
    return [done[output] for output in outputs]
