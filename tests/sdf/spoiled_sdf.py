"""A good SDF spoiled in one way each; what symgen says about each stands in expected/<group>.txt."""

from __future__ import annotations

from spoiled_files import Case, replaced

HEAD = "model: robot\nsdf: robot.sdf\ngravity: [0, 0, -9.81]\n"
ARM = """\
<?xml version="1.0"?>
<sdf version="1.9">
<model name="arm">
  <frame name="mount" attached_to="base"><pose>0 0 0.3 0 0 0</pose></frame>
  <link name="base"/>
  <link name="upper">
    <pose relative_to="mount">0 0 0 0 0.5 0</pose>
    <inertial>
      <pose>0.2 0 0 0 0 0</pose>
      <mass>2</mass>
      <inertia><ixx>0.01</ixx><iyy>0.05</iyy><izz>0.05</izz></inertia>
    </inertial>
  </link>
  <link name="lower">
    <pose relative_to="upper">0.4 0 0 0 0 0</pose>
    <inertial>
      <mass>1.5</mass>
      <inertia><ixx>0.01</ixx><iyy>0.04</iyy><izz>0.04</izz></inertia>
    </inertial>
  </link>
  <joint name="stand" type="fixed"><parent>world</parent><child>base</child></joint>
  <joint name="shoulder" type="revolute">
    <parent>base</parent><child>upper</child>
    <axis><xyz>0 1 0</xyz><limit><lower>-2</lower><upper>2</upper></limit></axis>
  </joint>
  <joint name="elbow" type="revolute">
    <parent>upper</parent><child>lower</child>
    <axis><xyz>0 1 0</xyz><dynamics><damping>0.1</damping></dynamics></axis>
  </joint>
</model>
</sdf>
"""


def changed(*pieces: str) -> Case:
    """The good file with pieces replaced."""
    return replaced((ARM, HEAD), *pieces)


def added(parts: str) -> Case:
    """The good model with further parts."""
    return changed("</model>", f"{parts}\n</model>")


AXIS = "<axis><xyz>0 1 0</xyz></axis>"
CLOSED = f'<joint name="last" type="revolute"><parent>base</parent><child>lower</child>{AXIS}</joint>'
DAMPED = CLOSED.replace("</xyz>", "</xyz><dynamics><damping>1</damping></dynamics>")
HOSTILE: dict[str, Case] = {
    "entity": ('<!DOCTYPE sdf [<!ENTITY x SYSTEM "file:///etc/passwd">]>\n<sdf version="&x;"/>\n', HEAD),
    "deep_nesting": ("<sdf>\n" + "<model>" * 200 + "</model>" * 200 + "</sdf>\n", HEAD),
    "many_links": ('<sdf><model name="m">\n' + '<link name="a"/>' * 501 + "\n</model></sdf>\n", HEAD),
    "unclosed": ("<sdf>\n  <model>\n", HEAD),
    "nothing": ("", HEAD),
    "code_for_a_number": changed("<mass>2<", "<mass>__import__('os')<"),
    "not_a_number": changed("<mass>2<", "<mass>nan<"),
    "long_name": changed('joint name="elbow"', f'joint name="{"a" * 60}"'),
    "comment_in_a_number": changed("0.2 0 0 0 0 0", "0.2 0 <!-- -->x 0 0 0"),
}
FILES: dict[str, Case] = {
    "not_sdf": ("<mujoco/>\n", HEAD),
    "no_model": ('<sdf version="1.9"/>\n', HEAD),
    "no_links": ('<sdf><model name="m"/></sdf>\n', HEAD),
    "above": (ARM, HEAD.replace("robot.sdf", "../robot.sdf")),
    "static": changed('<model name="arm">', '<model name="arm"><static>true</static>'),
    "two_models": changed("</sdf>", '<model name="other"><link name="x"/></model>\n</sdf>'),
    "include": added("<include><uri>model://hand</uri></include>"),
    "nested": added('<model name="hand"/>'),
    "plugin": added('<plugin name="wind" filename="wind.so"/>'),
    "unknown_part": added("<spring/>"),
    "world_with_an_include": (
        ARM.replace('<model name="arm">', '<world name="w"><include/><model name="arm">').replace(
            "</model>", "</model></world>"
        ),
        HEAD,
    ),
}
LINKS: dict[str, Case] = {
    "second_link": changed('link name="lower"', 'link name="upper"'),
    "link_and_joint_of_one_name": changed('joint name="elbow"', 'joint name="lower"'),
    "link_without_a_name": changed('<link name="lower">', "<link>"),
    "no_inertial": added(f'<link name="hand"/>{CLOSED.replace("base", "hand")}'),
    "no_mass": changed("<mass>2</mass>", ""),
    "no_inertia": changed("<izz>0.05</izz>", ""),
    "of_shapes": changed("<inertial>", '<inertial auto="true">'),
    "no_gravity": changed("<mass>2</mass>", "<mass>2</mass>", "<inertial>", "<gravity>false</gravity><inertial>"),
    "moved_from_outside": changed("<inertial>", "<kinematic>1</kinematic><inertial>"),
    "drag": changed("<inertial>", "<velocity_decay><linear>0.1</linear></velocity_decay><inertial>"),
    "misspelt": changed("<mass>2</mass>", "<mas>2</mas>"),
    "pose_of_three": changed("0.4 0 0 0 0 0", "0.4 0 0"),
    "pose_relative_to_nothing": changed('relative_to="upper"', 'relative_to="uper"'),
    "poses_in_a_circle": changed('relative_to="mount"', 'relative_to="lower"'),
    "frame_on_itself": changed('attached_to="base"', 'attached_to="mount"'),
    "pose_in_other_words": changed('<pose relative_to="upper">', '<pose frame="upper">'),
}
JOINTS: dict[str, Case] = {
    "unknown_type": changed('name="elbow" type="revolute"', 'name="elbow" type="screw"'),
    "no_child": changed("<child>lower</child>", ""),
    "unknown_parent": changed("<parent>upper</parent>", "<parent>uper</parent>"),
    "with_itself": changed("<parent>upper</parent>", "<parent>lower</parent>"),
    "no_axis": changed("<axis><xyz>0 1 0</xyz><dynamics><damping>0.1</damping></dynamics></axis>", ""),
    "no_second_axis": changed('name="elbow" type="revolute"', 'name="elbow" type="universal"'),
    "axis_of_length_zero": changed("<xyz>0 1 0</xyz><dynamics>", "<xyz>0 0 0</xyz><dynamics>"),
    "axis_in_unknown_axes": changed("<xyz>0 1 0</xyz><dynamics>", '<xyz expressed_in="x">0 1 0</xyz><dynamics>'),
    "no_way": changed("<lower>-2</lower>", "<lower>3</lower>"),
    "dry_friction": changed("<damping>0.1</damping>", "<friction>0.1</friction>"),
    "unknown_of_dynamics": changed("<damping>0.1</damping>", "<stiction>0.1</stiction>"),
    "damping_of_a_loop": added(DAMPED),
    "universal_loop": added(
        CLOSED.replace('"revolute"', '"universal"').replace("</joint>", "<axis2><xyz>1 0 0</xyz></axis2></joint>")
    ),
    "mimic_of_nothing": changed("<dynamics><damping>0.1</damping></dynamics>", '<mimic joint="sholder"/>'),
    "mimic_of_itself": changed("<dynamics><damping>0.1</damping></dynamics>", '<mimic joint="elbow"/>'),
    "second_axis": changed("</axis>\n  </joint>\n</model>", "</axis><axis/>\n  </joint>\n</model>"),
}
GROUPS = {"hostile": HOSTILE, "files": FILES, "links": LINKS, "joints": JOINTS}
