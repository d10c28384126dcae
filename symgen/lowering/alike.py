"""Kernels in which bodies take the same statements: blocks side by side that differ in their operands alone."""

from __future__ import annotations

from symgen.ir.kernel import Argument, Block, Kernel
from symgen.ir.lifted import Lifted, Meant, same_kernel
from symgen.lowering.writer import ScalarWriter, angles_among, angles_of
from symgen.mechanics.alike import TOGETHER, Alike
from symgen.methods.quantity import Quantity
from symgen.symbolic.angles.sharing import share_angles
from symgen.symbolic.traverse import topological


def alike_kernel(derived: Quantity, alike: Alike, arguments: tuple[Argument, ...]) -> Kernel | None:
    """u with the function of bodies evaluated for two of them at a time, each as soon as its arguments are known.

    None where a sine or cosine needs another one first.
    """
    graph = alike.mechanics.graph
    given = [x for one in alike.arguments for x in one]
    regular = share_angles(graph, [*given, *alike.inputs])
    order = topological(regular)
    angles = angles_among(order)
    if any(angles_of([angle]) for angle in angles):
        return None
    writer = ScalarWriter(alike.mechanics, [argument.name for argument in arguments], apart=False)
    blocks = [writer.angle_block(angles), Block(tuple(writer.pairs(angles, order)), ())]
    size, together = len(alike.names), []
    bodies = list(zip((regular[k : k + size] for k in range(0, len(given), size)), alike.results, strict=True))
    for start in range(0, len(bodies), TOGETHER):
        pair = bodies[start : start + TOGETHER]
        blocks.append(Block(tuple(writer.write([x for values, _ in pair for x in values])), ()))
        together.append(tuple(range(len(blocks), len(blocks) + len(pair))))
        for values, results in pair:
            operands = dict(zip(alike.names, map(writer.operand, values), strict=True))
            blocks.append(Block(tuple(writer.instance(alike.function, operands, results)), ()))
    outputs = regular[len(given) :]
    blocks.append(Block(tuple(writer.write(outputs)), ()))
    kernel = Kernel(
        name=derived.name,
        arguments=arguments,
        loads=writer.loads(),
        blocks=tuple(blocks),
        outputs=tuple(writer.operand(node) for node in outputs),
        shape=derived.shape,
        remark=derived.remark,
        alike=tuple(together),
    )
    same_kernel(f"bodies side by side in {derived.name}", Meant(derived.outputs, (), ()), Lifted(kernel))
    return kernel
