"""Angles that are computed from sines of others: what takes the place of a sine is made of what took their places."""

from __future__ import annotations

from symgen.symbolic.angles.sharing import angles_of, share_angles
from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import PI
from symgen.symbolic.traverse import reached


def test_an_angle_behind_shared_sines_is_computed_once() -> None:
    graph = Graph()
    x, turn = graph.symbol("x"), graph.const(2 * PI / 3)
    steps = [x]
    for _ in range(3):
        here = steps[-1]
        moved = graph.trig("sin", here) * graph.trig("cos", here + turn)
        steps.append(graph.function("rounded", (here + moved / 5,)))
    outputs = [graph.trig("sin", steps[-1]), graph.trig("sin", steps[-1] + turn)]
    shared = share_angles(graph, outputs)
    # one pair a step: the turned angle follows from it
    assert len(angles_of(outputs)) == 8
    assert len(angles_of(shared)) == 4
    assert len([node for node in reached(shared) if node.op == "rounded"]) == 3


def test_no_angle_follows_from_one_that_is_made_of_its_sine() -> None:
    graph = Graph()
    x, y = graph.symbol("x"), graph.symbol("y")
    made = graph.function("rounded", (graph.trig("sin", x + y),))
    # x + y = (x + made) - (made - y)
    outputs = [graph.trig("sin", made - y), graph.trig("sin", x + made), graph.trig("sin", x + y)]
    shared = share_angles(graph, outputs)
    assert x + y in angles_of(shared)
    assert len(angles_of(shared)) <= len(angles_of(outputs))


def test_an_angle_that_is_there_in_another_form_is_that_angle() -> None:
    graph = Graph()
    x = graph.symbol("x")
    again = graph.raw("sin", (graph.raw("add", (x, graph.zero)),))
    shared = share_angles(graph, [again, graph.trig("sin", x), graph.trig("cos", x)], [x])
    assert shared[1:] == [graph.trig("sin", x), graph.trig("cos", x)]
