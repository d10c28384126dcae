"""ROS 2: a plugin that compiles against the names it uses of the interface, and gives the bits of the C.

Nobody has ROS 2 here: the headers below declare what the plugin overrides and calls, as the published ones do.
"""

from __future__ import annotations

import re
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import handmade
import pytest
import shipped

from symgen.backends.ros2.backend import BACKEND
from symgen.backends.ros2.plugin import ANSWERS, APPLIED
from symgen.backends.ros2.reserved import package_name
from symgen.ir.kernel import Program
from symgen.lowering.schedule import schedule
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.quantities.select import derive_quantities

HEADERS = {
    "rclcpp/node_interfaces/node_parameters_interface.hpp": """\
#pragma once
#include <map>
#include <memory>
#include <string>
namespace rclcpp {
struct Parameter { double value; double as_double() const { return value; } };
namespace node_interfaces {
struct NodeParametersInterface {
    using ConstSharedPtr = std::shared_ptr<const NodeParametersInterface>;
    std::map<std::string, double> held;
    bool has_parameter(const std::string &name) const { return held.count(name) != 0; }
    Parameter get_parameter(const std::string &name) const { return Parameter{held.at(name)}; }
};
}
}
""",
    "inverse_dynamics_solver/inverse_dynamics_solver.h": """\
#pragma once
#include <eigen3/Eigen/Core>
#include <rclcpp/node_interfaces/node_parameters_interface.hpp>
namespace inverse_dynamics_solver {
struct InverseDynamicsSolver {
    using Vector = Eigen::VectorXd;
    virtual ~InverseDynamicsSolver() {}
    virtual void initialize(rclcpp::node_interfaces::NodeParametersInterface::ConstSharedPtr given = nullptr,
                            const std::string &space = "", const std::string &robot = "") = 0;
    virtual Eigen::MatrixXd getInertiaMatrix(const Vector &) const = 0;
    virtual Vector getCoriolisVector(const Vector &, const Vector &) const = 0;
    virtual Vector getGravityVector(const Vector &) const = 0;
    virtual Vector getFrictionVector(const Vector &) const = 0;
    virtual Vector getTorques(const Vector &, const Vector &, const Vector &) const = 0;
};
}
""",
    "pluginlib/class_list_macros.hpp": """\
#pragma once
#define PLUGINLIB_EXPORT_CLASS(Made, Base) Base *made(); Base *made() { return new Made(); }
""",
}
MAIN = """\
#include <cstdio>
#include <exception>
#include <memory>
#include <inverse_dynamics_solver/inverse_dynamics_solver.h>
using Vector = Eigen::VectorXd;
inverse_dynamics_solver::InverseDynamicsSolver *made();
template <typename Call> static void shown(Call call) {
    try {
        const Eigen::MatrixXd result = call();
        for (long i = 0; i < result.rows(); ++i) {
            for (long j = 0; j < result.cols(); ++j) {
                std::printf("%a ", result(i, j));
            }
        }
        std::printf("\\n");
    } catch (const std::exception &mistake) {
        std::printf("%s\\n", mistake.what());
    }
}
int main() {
    const std::unique_ptr<inverse_dynamics_solver::InverseDynamicsSolver> solver(made());
    auto held = std::make_shared<rclcpp::node_interfaces::NodeParametersInterface>();
    held->held = {PARAMETERS};
    solver->initialize(held, "car", "");
    Vector q(SIZE), qd(SIZE), qdd(SIZE);
    q << Q; qd << QD; qdd << QDD;
    shown([&] { return solver->getInertiaMatrix(q); });
    shown([&] { return solver->getCoriolisVector(q, qd); });
    shown([&] { return solver->getGravityVector(q); });
    shown([&] { return solver->getFrictionVector(qd); });
    shown([&] { return solver->getTorques(q, qd, qdd); });
    shown([&] { return solver->getTorques(1e9 * q, qd, qdd); });
    shown([&] { return solver->getTorques(Vector::Zero(1), qd, qdd); });
    return 0;
}
"""
# A cart that is braked in proportion to its speed, and a lift that is braked more the higher it is.
BRAKED = """\
model: Braked__Cart
coordinates: {x: {}, phi: {unit: rad}}
parameters: {m: {value: 3}, c: {value: 5}, m_2: {value: 2}}
kinetic_energy: m/2*x_dot**2 + m_2/2*(x_dot*cos(phi) + phi_dot)**2 + phi_dot**2
applied_forces: {x: FORCE}
inputs: {F: {acts_on: {x: 1}}, T: {acts_on: {phi: 1}}}
"""
Q, QD, QDD = (0.1, 0.3, 0.2, 0.4), (2.0, 0.0, 0.3, 0.1), (0.5, 0.1, 0.2, 0.3)


def written(model: Model, program: Program, folder: Path) -> Path:
    """The package of a model under `folder`."""
    assert BACKEND.around is not None
    files = BACKEND.around(model, [program])
    for variant in BACKEND.variants:
        files |= variant.emit(model, program)
    for path, text in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text, encoding="utf-8")
    return folder / "ros2"


def printed(
    tool: Callable[[str], str], model: Model, program: Program, folder: Path, parameters: str = ""
) -> list[str]:
    """What a program prints that calls the plugin."""
    package = written(model, program, folder)
    numbers = {name: ", ".join(map(repr, given[: model.n])) for name, given in (("Q", Q), ("QD", QD), ("QDD", QDD))}
    text = MAIN.replace("PARAMETERS", parameters).replace("SIZE", str(model.n))
    for name, given in numbers.items():
        text = text.replace(f"<< {name};", f"<< {given};")
    for path, header in {**HEADERS, "main.cpp": text}.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(header, encoding="utf-8")
    if not Path("/usr/include/eigen3/Eigen/Core").exists():
        tool("libeigen3-dev")
    flags = ["-Wall", "-Wextra", "-pedantic", "-ffp-contract=off", f"-I{folder}"]
    source = f"{package}/src/{model.c_name}"
    for command in (
        [tool("gcc"), "-std=c99", *flags, "-c", f"{source}.c", "-o", f"{folder}/kernels.o"],
        [tool("g++"), "-std=c++17", *flags, f"{package}/src/solver.cpp", "main.cpp", "kernels.o", "-lm", "-o", "main"],
    ):
        made = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        assert (made.returncode, made.stderr) == (0, "")
    return subprocess.run([folder / "main"], capture_output=True, text=True, check=True).stdout.splitlines()


def in_c(tool: Callable[[str], str], model: Model, folder: Path, quantity: str, arguments: str, count: int) -> str:
    """The same of the C alone."""
    name = model.c_name
    states = "\n".join(
        f"const double {kind}[] = {{{', '.join(map(repr, given[: model.n]))}}}; (void){kind};"
        for kind, given in (("q", Q), ("qd", QD), ("qdd", QDD))
    )
    text = f"""#include <stdio.h>
#include "{name}.h"
int main(void) {{
    {name}_params p = {name}_default_params();
    double y[{count}];
    {states}
    (void){name}_{quantity}({arguments}, &p, y);
    for (int k = 0; k < {count}; ++k) {{ printf("%a ", y[k]); }}
    return 0;
}}
"""
    (folder / "alone.c").write_text(text)
    source = f"{folder}/ros2/src"
    command = [tool("gcc"), "-ffp-contract=off", f"-I{source}", "alone.c", f"{source}/{name}.c", "-lm", "-o", "alone"]
    subprocess.run(command, cwd=folder, check=True)
    return subprocess.run([folder / "alone"], capture_output=True, text=True, check=True).stdout


@pytest.mark.toolchain
@pytest.mark.slow
@pytest.mark.campaign
def test_answers_with_the_bits_of_the_c(tool: Callable[[str], str], tmp_path: Path) -> None:
    model, program = shipped.model("front_car"), shipped.programs("front_car")["float64"]
    lines = printed(tool, model, program, tmp_path)
    calls = (
        ("mass_matrix", "q", 16), ("coriolis_force", "q, qd", 4), ("potential_force", "q", 4),
        ("inverse_dynamics", "q, qd, qdd", 2),
    )  # fmt: skip
    wanted = [in_c(tool, model, tmp_path, *call) for call in calls]
    assert [*lines[:3], lines[4]] == wanted
    # nothing rubs there
    assert {float.fromhex(x) for x in lines[3].split()} == {0.0}
    package = package_name("front_car")
    assert lines[5] == f"{package}: an angle is beyond the range of the sine and cosine"
    assert lines[6] == f"{package}: vectors have 4 entries, one for each coordinate"


@pytest.mark.toolchain
@pytest.mark.campaign
@pytest.mark.parametrize(("force", "answer"), [("-c*x_dot", "10 0"), ("-c*x**2*x_dot", "depend on positions")])
def test_friction_is_what_rates_alone_tell(
    tool: Callable[[str], str], tmp_path: Path, force: str, answer: str
) -> None:
    """With a parameter of the node, and a name that a package cannot have."""
    model = load_text(BRAKED.replace("FORCE", force), "braked.yaml")
    names = (*ANSWERS.values(), APPLIED)
    derived = derive_quantities(model, names)
    program = schedule(derived.mechanics, derived.quantities, ("float64",))["float64"]
    lines = printed(tool, model, program, tmp_path, '{"car.m", 30.0}')
    given = " ".join(f"{float.fromhex(x) + 0:g}" for x in lines[3].split()) if "0x" in lines[3] else lines[3]
    assert answer in given
    assert float.fromhex(lines[0].split()[0]) > 30
    assert package_name(model.c_name) == "braked_cart_inverse_dynamics_solver"
    few = replace(program, kernels=tuple(one for one in program.kernels if one.name == ANSWERS["getTorques"]))
    lines = printed(tool, model, few, tmp_path)
    assert [line.partition("generated without ")[2] for line in lines[:4]] == [*list(ANSWERS.values())[:3], APPLIED]


def test_files_of_the_package_name_each_other() -> None:
    model, program = handmade.model(), handmade.program()
    assert BACKEND.around is not None
    files = BACKEND.around(replace(model, description="arms < legs & \"springs\""), [program])
    name = package_name(model.c_name)
    package, plugin = (ElementTree.fromstring(files[f"ros2/{path}.xml"]) for path in ("package", "plugin"))
    assert package.findtext("name") == name
    assert "arms < legs & \"springs\"" in str(package.findtext("description"))
    (library,) = plugin.findall("class")
    assert (plugin.get("path"), library.get("type")) == (name, f"{name}::Solver")
    assert f"project({name} " in files["ros2/CMakeLists.txt"]
    assert f"src/{model.c_name}.c)" in files["ros2/CMakeLists.txt"]
    assert re.search(rf"PLUGINLIB_EXPORT_CLASS\({name}::Solver, ", files["ros2/src/solver.cpp"])
    assert BACKEND.around(model, [replace(program, kernels=())]) == {}
