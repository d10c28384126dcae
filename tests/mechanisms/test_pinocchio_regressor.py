"""Columns of the regressor against Pinocchio's, which knows them for open trees, a body of ten for each joint."""

from __future__ import annotations

import numpy as np
import pytest
from pinocchio_tree import Tree, pinocchio
from shipped import ROOT

from symgen.model.inertial_parameters import inertial_parameters
from symgen.model.load import load_model
from symgen.quantities.select import derive_quantities
from symgen.symbolic.evaluate import Evaluator

# Of a body in Pinocchio's order.
ORDER = ("m", "mx", "my", "mz", "Ixx", "Ixy", "Iyy", "Ixz", "Iyz", "Izz")


@pytest.mark.parametrize("name", ["arm7", "scara"])
def test_columns_are_those_of_pinocchio(name: str) -> None:
    model = load_model(ROOT / "models" / f"{name}.yaml")
    tree = Tree(model)
    control, derived = derive_quantities(model, ["control_matrix", "regressor"]).quantities
    kernel, names = Evaluator(derived.outputs), [one.name for one in inertial_parameters(model.mechanism)]
    loads = Evaluator(control.outputs)
    source = np.random.default_rng(8)
    seen = 0
    for _ in range(5):
        q, qd, qdd = source.normal(size=(3, model.n))
        at = tree.parameters | dict(zip((c.name for c in model.coordinates), q, strict=True))
        at |= dict(zip((c.rate for c in model.coordinates), qd, strict=True))
        at |= dict(zip((c.acceleration for c in model.coordinates), qdd, strict=True))
        # motors may load several joints: M Y
        own = np.array(loads(at)).reshape(control.shape) @ np.array(kernel(at)).reshape(derived.shape)
        order = tree.moved
        theirs = pinocchio.computeJointTorqueRegressor(tree.tree, tree.data, q[order], qd[order], qdd[order])
        for body in model.mechanism.bodies:
            joint, place = tree.places[body.frame]
            assert place.isIdentity(1e-14)
            for k, element in enumerate(ORDER):
                column = own[:, names.index(f"{body.name}.{element}")]
                wanted = np.empty(model.n)
                wanted[order] = theirs[:, 10 * (joint - 1) + k]
                assert np.abs(column - wanted).max() < 1e-12 * (1 + np.abs(theirs).max())
                seen += bool(np.abs(wanted).max() > 1e-3)
    # nine columns of the SCARA count, more of the arm
    assert seen >= 5 * 9
