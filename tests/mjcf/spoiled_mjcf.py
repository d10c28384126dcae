"""A good MJCF file spoiled in one way each; what symgen says about each stands in expected/<group>.txt."""

from __future__ import annotations

from spoiled_files import Case, replaced

HEAD = "model: robot\nmjcf: robot.xml\n"
ARM = """\
<mujoco model="arm">
  <compiler angle="radian"/>
  <default>
    <joint damping="0.1"/>
    <default class="thin"><geom size="0.02 0.1"/></default>
  </default>
  <worldbody>
    <geom type="plane" size="1 1 1"/>
    <body name="upper" pos="0 0 0.3">
      <joint name="shoulder" axis="0 1 0" range="-2 2"/>
      <geom name="bar" type="capsule" class="thin" pos="0.2 0 0"/>
      <body name="lower" pos="0.4 0 0" quat="1 0 0 0">
        <joint name="elbow" axis="0 1 0"/>
        <inertial mass="1.5" pos="0.2 0 0" diaginertia="0.01 0.02 0.02"/>
        <site name="tip" pos="0.4 0 0"/>
      </body>
    </body>
    <body name="ball" pos="1 0 0">
      <joint name="socket" type="ball" damping="0"/>
      <geom size="0.1" pos="0 0 -0.2"/>
    </body>
  </worldbody>
  <equality><connect name="pin" body1="lower" body2="ball" anchor="0.4 0 0"/></equality>
  <actuator><motor name="drive" joint="shoulder" gear="2"/></actuator>
</mujoco>
"""


def changed(*pieces: str) -> Case:
    """The good file with pieces replaced."""
    return replaced((ARM, HEAD), *pieces)


def imported_as(mjcf: str) -> Case:
    """The good file, imported in another way."""
    return ARM, HEAD.replace("robot.xml", mjcf)


def added(section: str) -> Case:
    """The good file with a further section."""
    return changed("</mujoco>", f"{section}\n</mujoco>")


def equal(text: str) -> Case:
    """The good file with other equalities."""
    return changed('<connect name="pin" body1="lower" body2="ball" anchor="0.4 0 0"/>', text)


def driven(text: str) -> Case:
    """The good file with other actuators."""
    return changed('<motor name="drive" joint="shoulder" gear="2"/>', text)


DEEP = "<body>" * 200 + "</body>" * 200
HOSTILE: dict[str, Case] = {
    "entity": ('<!DOCTYPE mujoco [<!ENTITY x SYSTEM "file:///etc/passwd">]>\n<mujoco model="&x;"/>\n', HEAD),
    "deep_nesting": (f"<mujoco>\n<worldbody>{DEEP}</worldbody></mujoco>\n", HEAD),
    "many_elements": ("<mujoco>\n" + "<size/>" * 30_000 + "\n</mujoco>\n", HEAD),
    "many_bodies": ("<mujoco><worldbody>\n" + "<body/>" * 600 + "\n</worldbody></mujoco>\n", HEAD),
    "many_equalities": equal("<connect/>" * 600),
    "inclusion": changed("<worldbody>", '<include file="/etc/passwd"/>\n  <worldbody>'),
    "unclosed": ("<mujoco>\n  <worldbody>\n", HEAD),
    "nothing": ("", HEAD),
    "code_for_a_number": changed('mass="1.5"', "mass=\"__import__('os')\""),
    "long_name": changed('joint name="elbow"', f'joint name="{"a" * 60}"'),
    "huge_size": changed('size="0.1"', 'size="1e200"'),
    "tiny_axis": changed('axis="0 1 0" range', 'axis="1e-200 0 0" range'),
    "not_a_number": changed('mass="1.5"', 'mass="nan"'),
}
FILES: dict[str, Case] = {
    "not_mjcf": ('<robot name="r"/>\n', HEAD),
    "no_bodies": ("<mujoco/>\n", HEAD),
    "above": imported_as("../robot.xml"),
    "two_descriptions": (ARM, f"{HEAD}urdf: robot.urdf\n"),
    "unknown_key": imported_as("{file: robot.xml, leave: [a]}"),
    "second_mass": (ARM, f"{HEAD}bodies: {{upper: {{mass: 1}}}}\n"),
    "taken_by_the_model_file": (ARM, f"{HEAD}parameters: {{elbow: 1}}\n"),
    "angles_of_no_axes": changed('angle="radian"', 'angle="radian" eulerseq="abc"'),
    "masses_changed": changed('angle="radian"', 'angle="radian" settotalmass="3"'),
    "fluid": added('<option density="1.2" viscosity="0.00002"/>'),
    "switched_off": added('<option><flag gravity="disable"/></option>'),
    "tendon": added('<tendon><fixed name="t"><joint joint="elbow" coef="1"/></fixed></tendon>'),
    "plugin": added('<extension><plugin plugin="x"/></extension>'),
    "unknown_section": added("<muscles/>"),
}
BODIES: dict[str, Case] = {
    "second_body": changed('body name="lower"', 'body name="upper"'),
    "second_joint": changed('joint name="elbow"', 'joint name="shoulder"'),
    "joint_and_body_of_one_name": changed('joint name="elbow"', 'joint name="lower"'),
    "unknown_joint": changed('<joint name="elbow"', '<joint type="hing" name="elbow"'),
    "misspelt_attribute": changed('mass="1.5"', 'mas="1.5"'),
    "unknown_attribute_of_a_default": changed('<joint damping="0.1"/>', '<joint damping="0.1" dampng="3"/>'),
    "unknown_class": changed('class="thin" pos', 'class="thn" pos'),
    "class_without_a_name": changed('<default class="thin">', "<default>"),
    "two_turns": changed('quat="1 0 0 0"', 'quat="1 0 0 0" euler="0 0 1"'),
    "quaternion_of_0": changed('quat="1 0 0 0"', 'quat="0 0 0 0"'),
    "turn_of_three": changed('quat="1 0 0 0"', 'quat="1 0 0"'),
    "axis_of_length_zero": changed('axis="0 1 0" range', 'axis="0 0 0" range'),
    "no_way": changed('range="-2 2"', 'range="2 -2" limited="true"'),
    "gravity_off": changed('body name="ball"', 'body name="ball" gravcomp="1"'),
    "moved_from_outside": changed('body name="ball"', 'body name="ball" mocap="true"'),
    "copies": changed('<body name="ball"', '<replicate count="3"/><body name="ball"'),
    "composite": changed('<body name="ball"', '<composite type="cable"/><body name="ball"'),
    "damped_ball": changed('type="ball" damping="0"', 'type="ball"'),
    "bending_spring": changed('name="elbow"', 'name="elbow" stiffness="1 2"'),
    "spring_by_time": changed('name="elbow"', 'name="elbow" springdamper="0.1 1"'),
    "dry_friction": changed('name="elbow"', 'name="elbow" frictionloss="0.2"'),
    "free_inside": changed('<joint name="elbow" axis="0 1 0"/>', '<freejoint name="elbow"/>'),
    "mesh": changed('type="capsule" class="thin"', 'type="mesh" mesh="m"'),
    "shell": changed('<geom size="0.1" pos', '<geom size="0.1" shellinertia="true" pos'),
    "no_size": changed('<geom size="0.1" pos', "<geom pos"),
    "negative_size": changed('<geom size="0.1" pos', '<geom size="-0.1" pos'),
    "no_inertia": changed(' diaginertia="0.01 0.02 0.02"', ""),
    "text_in_a_body": changed('<site name="tip" pos="0.4 0 0"/>', "tip"),
}
ROWS: dict[str, Case] = {
    "unknown_body": equal('<connect body1="lwer" body2="ball" anchor="0 0 0"/>'),
    "no_anchor": equal('<connect body1="lower" body2="ball"/>'),
    "unknown_site": equal('<connect site1="tip" site2="tap"/>'),
    "joint_of_a_ball": equal('<joint joint1="socket" joint2="elbow"/>'),
    "unknown_joint": equal('<joint joint1="elbow" joint2="sholder"/>'),
    "many_coefficients": equal('<joint joint1="elbow" joint2="shoulder" polycoef="0 1 2 3 4 5"/>'),
    "tendon": equal('<tendon tendon1="t"/>'),
    "unknown_equality": equal('<conect body1="lower"/>'),
    "servo": driven('<position name="servo" joint="elbow" kp="10"/>'),
    "unknown_driven": driven('<motor name="m" joint="elbo"/>'),
    "at_a_site": driven('<motor name="m" site="tip"/>'),
    "general_servo": driven('<general name="g" joint="elbow" biastype="affine" biasprm="0 -1 0"/>'),
    "default_servo": changed(
        "<default>\n", '<default><position kp="3"/>\n', '<motor name="drive"', '<general name="drive"'
    ),
    "rotor_of_a_motor": driven('<motor name="m" joint="elbow" armature="0.1"/>'),
}
GROUPS = {"hostile": HOSTILE, "files": FILES, "bodies": BODIES, "rows": ROWS}
