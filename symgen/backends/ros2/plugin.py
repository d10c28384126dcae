"""What stands around the C: the plugin, and the three files that make a package of it.

The interface is that of the package `inverse_dynamics_solver`: vectors of joint positions, velocities and
accelerations, here the coordinates in the order of the model file; torques, here the inputs.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from symgen import __version__
from symgen.backends.c.elsewhere import CallerNames, KernelCall, caller_names, heading, kernel_call, titled
from symgen.backends.c.names import c_members
from symgen.backends.render import render
from symgen.backends.ros2.reserved import package_name
from symgen.ir.kernel import Program
from symgen.model.model import Model
from symgen.records import dataclass

# By function of the interface, the quantity that answers it.
ANSWERS = {
    "getInertiaMatrix": "mass_matrix",
    "getCoriolisVector": "coriolis_force",
    "getGravityVector": "potential_force",
    "getTorques": "inverse_dynamics",
}
# What friction is part of, on the right-hand side.
APPLIED = "applied_force"


@dataclass(frozen=True, slots=True)
class PluginView:
    """Everything the templates print; `fields` are parameters by name and in C, `answers` kernels by the functions of
    the interface.

    `friction` is what forces are applied, where that is made; whether it `depends` on more than rates is what the
    interface, which gives it these alone, has no place for.
    """

    package: str
    version: str
    description: str
    about: tuple[str, ...]
    c: CallerNames
    coordinates: int
    fields: tuple[tuple[str, str], ...]
    answers: dict[str, KernelCall]
    friction: KernelCall | None
    depends: bool


def lacking_torques(_: Model, made: frozenset[str]) -> Iterator[str]:
    """That there is no plugin."""
    if ANSWERS["getTorques"] not in made:
        yield f"there is no plugin, only the C: it answers with `{ANSWERS['getTorques']}`, which outputs have not"


def emit_plugin(model: Model, programs: Sequence[Program]) -> dict[str, str]:
    """The package, where there are inputs to be worked out."""
    (program,) = programs
    kernels = {kernel.name: kernel for kernel in program.kernels}
    applied = kernels.get(APPLIED)
    if ANSWERS["getTorques"] not in kernels:
        return {}
    description = titled(model)
    members = c_members(model, program)
    view = PluginView(
        package=package_name(model.c_name),
        version=__version__,
        description=description,
        about=heading(model, description),
        c=caller_names(model, program),
        coordinates=model.n,
        fields=tuple((one.name, members[one.name]) for one in model.parameters),
        answers={name: kernel_call(model, program, kernels[of]) for name, of in ANSWERS.items() if of in kernels},
        friction=kernel_call(model, program, applied) if applied is not None else None,
        depends=applied is None or any(load.argument not in ("qd", "p") for load in applied.loads),
    )
    files = {
        "src/solver.cpp": "ros2/solver.cpp.jinja",
        "CMakeLists.txt": "ros2/cmake.jinja",
        "package.xml": "ros2/package.xml.jinja",
        "plugin.xml": "ros2/plugin.xml.jinja",
    }
    return {f"ros2/{path}": render(template, view) for path, template in files.items()}
