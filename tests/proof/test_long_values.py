"""Values that are worked out in thousands of steps, one from the other, are told by name; short ones by the inputs."""

from __future__ import annotations

from fractions import Fraction

from symgen.ir.kernel import Block, Kernel, Literal, Local, Statement
from symgen.proof.files import _text, _texts

STEPS = 5000


def test_a_long_chain_of_values_is_told_by_name() -> None:
    half = Literal(Fraction(1, 2))
    chain = [Statement(("v0",), "add", (Local("q_x"), half)), Statement(("s", "c"), "sincos", (Local("v0"),))]
    chain += [Statement((f"v{k}",), "mul", (Local(f"v{k - 1}"), Local("c"))) for k in range(1, STEPS)]
    chain.append(Statement(("w",), "neg", (Local("s"),)))
    kernel = Kernel("singularity", (), (), (Block(tuple(chain), ()),), (Local("w"),), (1,))
    texts = _texts(kernel)
    assert _text(texts, "v0") == "q_x + 1/2"
    assert _text(texts, "w") == "-sin((q_x + 1/2))"
    assert _text(texts, "v1") == "(q_x + 1/2) * cos((q_x + 1/2))"
    assert _text(texts, f"v{STEPS - 1}") == f"v{STEPS - 1}"
    assert _text(texts, "q_y") == "q_y"
