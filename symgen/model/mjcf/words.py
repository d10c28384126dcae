"""The words of MJCF that are read, those that say nothing about the motion, and why others are refused."""

from __future__ import annotations

TURNS = ("quat", "axisangle", "xyaxes", "zaxis", "euler")
BODY = ("name", "childclass", "pos", *TURNS, "mocap", "gravcomp", "user", "sleep", "fuse")
FRAME = ("name", "childclass", "pos", *TURNS)
INERTIAL = ("pos", *TURNS, "mass", "diaginertia", "fullinertia")
CONTACT = ("margin", "solreflimit", "solimplimit", "solreffriction", "solimpfriction")
LIMITS = ("actuatorfrclimited", "actuatorfrcrange")
JOINT = (
    "name", "class", "type", "pos", "axis", "range", "limited", "ref", "springref", "armature", "damping",
    "frictionloss", "stiffness", "group", "user", "springdamper", "springyield", "actuatorgravcomp", *CONTACT, *LIMITS,
)  # fmt: skip
GEOM = (
    "name", "class", "type", "pos", *TURNS, "size", "fromto", "mass", "density", "shellinertia", "contype",
    "conaffinity", "condim", "group", "priority", "material", "friction", "solmix", "solref", "solimp", "margin", "gap",
    "hfield", "mesh", "fitscale", "rgba", "fluidshape", "fluidcoef", "user", "adhesion", "castshadow", "surfacevel",
)  # fmt: skip
SITE = ("name", "class", "type", "pos", *TURNS, "fromto", "size", "group", "material", "mesh", "rgba", "user")
EQUALITY = ("name", "class", "active", "solref", "solimp")
ACTUATOR = (
    "name", "class", "group", "joint", "gear", "ctrllimited", "forcelimited", "ctrlrange", "forcerange", "lengthrange",
    "user", "armature", "damping", "interp", "nsample", "delay",
)  # fmt: skip
GENERAL = ("gaintype", "gainprm", "biastype", "biasprm", "dyntype", "dynprm")
COMPILER = (
    "angle", "eulerseq", "autolimits", "inertiafromgeom", "inertiagrouprange", "balanceinertia", "boundmass",
    "boundinertia", "settotalmass", "alignfree", "assetdir", "meshdir", "texturedir", "strippath", "discardvisual",
    "usethread", "fusestatic", "fitaabb", "saveinertial", "conflict", "coordinate", "savecanonical", "savecompiled",
)  # fmt: skip
OPTION = (
    "gravity", "density", "viscosity", "timestep", "impratio", "tolerance", "ls_tolerance", "noslip_tolerance",
    "ccd_tolerance", "sleep_tolerance", "iterations", "ls_iterations", "noslip_iterations", "ccd_iterations",
    "sdf_iterations", "sdf_initpoints", "integrator", "cone", "jacobian", "solver", "wind", "magnetic", "o_margin",
    "o_solref", "o_solimp", "o_friction",
)  # fmt: skip
# switches of `option` that take forces away
SWITCHES = ("constraint", "equality", "frictionloss", "spring", "damper", "passive", "gravity", "actuation")

# parts of `mujoco` that are read; those that take no part; and those that change the motion, with a remedy
SECTIONS = ("compiler", "option", "default", "worldbody", "equality", "actuator")
IDLE_SECTIONS = ("size", "statistic", "visual", "asset", "contact", "sensor", "keyframe", "custom")
REFUSED_SECTIONS = {
    "tendon": ("tendons bring forces and rows", "write them as `springs`, `coupling` or cables in the model file"),
    "deformable": ("bodies that deform are no rigid bodies", "remove them, or put a rigid body in their place"),
    "extension": ("plugins may bring forces", "write their forces under `forces` of the model file"),
    "include": ("one file is read", "put the text of the other file in its place"),
}
IDLE_PARTS = ("camera", "light")
REFUSED_PARTS = {
    "composite": ("symgen does not make its parts", "write its bodies out"),
    "flexcomp": ("bodies that deform are no rigid bodies", "put a rigid body in its place"),
    "replicate": ("symgen does not make its copies", "write them out"),
    "attach": ("one file is read", "put the text of the other model in its place"),
    "include": ("one file is read", "put the text of the other file in its place"),
    "plugin": ("plugins may bring forces", "write their forces under `forces` of the model file"),
}
REFUSED_EQUALITIES = {
    "tendon": ("there are no tendons", "write a row under `constraints` of the model file"),
    "flex": ("bodies that deform are no rigid bodies", "remove it"),
    "flexvert": ("bodies that deform are no rigid bodies", "remove it"),
    "flexstrain": ("bodies that deform are no rigid bodies", "remove it"),
}
SERVO = "its input is no force"
TORQUE = "make it a `motor`, or leave it out and write an input in the model file"
