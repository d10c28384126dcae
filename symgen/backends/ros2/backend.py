"""ROS 2: the kernels for one state in float64, as a plugin."""

from __future__ import annotations

from symgen.backends.backend import Backend, Variant
from symgen.backends.c.elsewhere import emit_c_into
from symgen.backends.ros2.plugin import emit_plugin, lacking_torques

BACKEND = Backend(
    "ros2",
    "ROS 2",
    (Variant(emit_c_into("ros2/src")),),
    (".h", ".c"),
    "c",
    of_each_scalar=False,
    folder="ros2/src",
    around=emit_plugin,
    lacks=lacking_torques,
)
