"""The words of SDF that are read, those that say nothing about the motion, and why others are refused."""

from __future__ import annotations

PLUGIN = ("plugins may bring forces", "write their forces under `forces` of the model file")
INCLUDE = ("one file is read", "put the text of the other file in its place")
NESTED = ("models inside of models are not read", "write their links and joints into this model")
WORLD_IDLE = (
    "scene", "light", "gui", "physics", "magnetic_field", "atmosphere", "spherical_coordinates", "audio", "road",
    "state", "frame", "wind",
)  # fmt: skip
WORLD_REFUSED = {
    "include": INCLUDE,
    "plugin": PLUGIN,
    "joint": ("joints between models are not read", "write all links and joints into one model"),
    "actor": ("actors move by scripts", "remove it"),
    "population": ("symgen does not make its copies", "write them out"),
}
MODEL_ATTRIBUTES = ("name", "canonical_link")
MODEL_READ = ("static", "pose", "link", "joint", "frame")
MODEL_IDLE = ("self_collide", "allow_auto_disable", "gripper")
MODEL_REFUSED = {"include": INCLUDE, "model": NESTED, "plugin": PLUGIN}
LINK_READ = ("pose", "inertial", "gravity", "kinematic", "velocity_decay", "enable_wind")
LINK_IDLE = (
    "visual", "collision", "sensor", "self_collide", "must_be_base_link", "projector", "light", "particle_emitter",
    "audio_source", "audio_sink", "battery",
)  # fmt: skip
JOINT_READ = ("parent", "child", "pose", "axis", "axis2")
JOINT_IDLE = ("physics", "sensor", "gearbox_ratio", "gearbox_reference_body", "thread_pitch", "screw_thread_pitch")
AXIS_READ = ("xyz", "limit", "dynamics", "mimic", "use_parent_model_frame", "initial_position")
LIMIT_READ = ("lower", "upper", "velocity", "effort", "stiffness", "dissipation")
DYNAMICS = {"damping": "viscous", "friction": "dry", "spring_stiffness": "stiffness", "spring_reference": "unstretched"}
TENSOR = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
# the motions of each type of joint, one to an axis
TYPES: dict[str, tuple[str, ...]] = {
    "revolute": ("revolute",),
    "continuous": ("revolute",),
    "prismatic": ("prismatic",),
    "fixed": (),
    "ball": ("spherical",),
    "universal": ("revolute", "revolute"),
    "revolute2": ("revolute", "revolute"),
}
# what closes a loop as each type does
LOOPS = {"revolute": "revolute", "continuous": "revolute", "prismatic": "prismatic", "fixed": "fixed", "ball": "point"}
