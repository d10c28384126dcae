"""The mechanical system on the scalar graph: kinematics, forces, inertias, constraints, structure."""
