"""A good robot spoiled in one way each; what symgen says about each stands in expected/<group>.txt."""

from __future__ import annotations

from robots import ARM, HEAD
from spoiled_files import Case, replaced


def changed(*pieces: str) -> Case:
    """The good file with pieces replaced."""
    return replaced((ARM, HEAD), *pieces)


def imported_as(urdf: str) -> Case:
    """The good robot, imported in another way."""
    return ARM, HEAD.replace("robot.urdf", urdf)


ELBOW_LIMIT = '<axis xyz="0 0 1"/>\n    <dynamics damping="0.1"/>'
BILLION = "".join(f'<!ENTITY l{k} "{f"&l{k - 1};" * 10}">' for k in range(1, 10))
HOSTILE: dict[str, Case] = {
    "billion_laughs": (
        f'<?xml version="1.0"?>\n<!DOCTYPE robot [<!ENTITY l0 "lol">{BILLION}]>\n<robot name="&l9;"/>\n',
        HEAD,
    ),
    "external_entity": ('<!DOCTYPE robot [<!ENTITY x SYSTEM "file:///etc/passwd">]>\n<robot name="&x;"/>\n', HEAD),
    "external_document_type": ('<!DOCTYPE robot SYSTEM "http://example.org/robot.dtd">\n<robot name="r"/>\n', HEAD),
    "parameter_entity": ('<!DOCTYPE r [<!ENTITY % p SYSTEM "http://example.org/p"> %p;]>\n<robot/>\n', HEAD),
    "unknown_entity": ('<robot name="&boom;"/>\n', HEAD),
    "inclusion": changed(
        '<link name="base"/>',
        '<link name="base"/><xi:include xmlns:xi="http://www.w3.org/2001/XInclude" href="/etc/passwd" parse="text"/>',
    ),
    "deep_nesting": ('<robot name="r">\n' + "<link>" * 200 + "</link>" * 200 + "</robot>\n", HEAD),
    "many_elements": ('<robot name="r">\n' + "<link/>" * 30_000 + "\n</robot>\n", HEAD),
    "huge_file": ('<robot name="' + "a" * 1_000_001 + '"/>\n', HEAD),
    "control_character": ('<robot name="a\x07b"/>\n', HEAD),
    "null_character": ('<robot name="a\x00b"/>\n', HEAD),
    "second_root": ('<robot name="r"/>\n<robot name="s"/>\n', HEAD),
    "unclosed": ('<robot name="r">\n  <link name="a">\n', HEAD),
    "attribute_twice": ('<robot name="r" name="s"/>\n', HEAD),
    "nothing": ("", HEAD),
    "not_xml": ("model: arm\n", HEAD),
    "escape_in_a_name": changed('name="upper"', 'name="upper&#x9b;31m"'),
    "huge_number": changed('value="2"', 'value="1e999999999"'),
    "many_digits": changed('value="2"', f'value="{"9" * 50}"'),
    "not_a_number": changed('value="2"', 'value="nan"'),
    "code_for_a_number": changed('value="2"', "value=\"__import__('os')\""),
}
PATHS: dict[str, Case] = {
    "absolute": imported_as("/etc/passwd"),
    "above": imported_as("meshes/../../robot.urdf"),
    "windows": imported_as("'C:\\robot.urdf'"),
    "address": imported_as("'http://example.org/robot.urdf'"),
    "absent": imported_as("robots.urdf"),
    "folder": imported_as("."),
    "unknown_key": imported_as("{file: robot.urdf, leave: [a]}"),
    "no_file": imported_as("{leave_out: [a]}"),
}
TREE: dict[str, Case] = {
    "not_a_robot": ("<sdf><model/></sdf>\n", HEAD),
    "too_many_links": ('<robot name="r">\n' + '<link name="a"/>' * 501 + "</robot>\n", HEAD),
    "no_links": ('<robot name="r"/>\n', HEAD),
    "unknown_parent": changed('<parent link="upper"/>', '<parent link="uper"/>'),
    "two_roots": changed('<link name="base"/>', '<link name="base"/><link name="stray"/>'),
    "two_parents": changed('<child link="lower"/>', '<child link="upper"/>'),
    "circle": changed('<parent link="base"/>', '<parent link="lower"/>'),
    "second_link": changed('name="lower"', 'name="upper"'),
    "second_joint": changed('joint name="elbow"', 'joint name="shoulder"'),
    "link_without_name": changed('<link name="base"/>', "<link/>"),
    "no_child": changed('<child link="lower"/>', ""),
    "joint_and_link_of_one_name": changed('joint name="elbow"', 'joint name="lower"'),
    "reserved_name": changed('joint name="elbow"', 'joint name="while"'),
    "long_name": changed('joint name="elbow"', f'joint name="{"a" * 60}"'),
    "unknown_renamed": imported_as("{file: robot.urdf, coordinates: {a_1: sholder}, frames: {b: elbow}}"),
    "named_twice": imported_as("{file: robot.urdf, coordinates: {a_1: elbow, a_2: elbow}}"),
    "taken_by_the_model_file": (ARM, f"{HEAD}parameters: {{elbow: 1}}\n"),
    "second_mass": (ARM, f"{HEAD}bodies: {{upper: {{mass: 1}}}}\n"),
}
JOINTS: dict[str, Case] = {
    "unknown_type": changed('type="continuous"', 'type="continous"'),
    "spherical": changed('type="continuous"', 'type="ball"'),
    "no_limit": changed('type="continuous"', 'type="revolute"'),
    "no_way": changed('lower="-2" upper="2"', 'lower="2" upper="-2"'),
    "endless": changed('lower="-2" upper="2"', 'lower="-1e16" upper="1e16"'),
    "negative_velocity": changed('velocity="3"', 'velocity="-3"'),
    "axis_of_length_zero": changed('<axis xyz="0 0 1"/>', '<axis xyz="0 0 0"/>'),
    "axis_of_two": changed('<axis xyz="0 0 1"/>', '<axis xyz="0 1"/>'),
    "planar_across": changed('type="revolute"', 'type="planar"', '<axis xyz="0 0 1"/>', '<axis xyz="0 1 0"/>'),
    "friction_of_a_floating_joint": changed('type="continuous"', 'type="floating"'),
    "dry_friction": changed('damping="0.1"', 'damping="0.1" friction="0.3"'),
    "unknown_attribute": changed('damping="0.1"', 'damping="0.1" mu_coulomb="0.3"'),
    "misspelt_attribute": changed('damping="0.1"', 'dampng="0.1"'),
    "mimic_of_nothing": changed(ELBOW_LIMIT, '<axis xyz="0 0 1"/><mimic joint="sholder"/>'),
    "mimic_of_itself": changed(ELBOW_LIMIT, '<axis xyz="0 0 1"/><mimic joint="elbow"/>'),
    "mimic_of_a_floating_joint": changed(
        'type="continuous"', 'type="floating"', '<dynamics damping="0.1"/>', '<mimic joint="shoulder"/>'
    ),
    "text_in_an_element": changed('<axis xyz="0 0 1"/>', "<axis>0 0 1</axis>"),
    "second_axis": changed('<axis xyz="0 0 1"/>', '<axis xyz="0 0 1"/><axis xyz="0 1 0"/>'),
}
PARTS: dict[str, Case] = {
    "unknown_element": changed('<link name="base"/>', '<link name="base"><spring/></link>'),
    "misspelt_element": changed('<link name="base"/>', '<link name="base"><inertal/></link>'),
    "xacro": changed('<link name="base"/>', '<xacro:include filename="a.xacro"/><link name="base"/>'),
    "motor_inertia": changed(
        "</robot>", '<transmission name="gear"><motorInertia>5</motorInertia></transmission></robot>'
    ),
    "joint_for_a_simulator": changed("</robot>", '<gazebo><joint name="cut" type="revolute"/></gazebo></robot>'),
    "no_mass": changed('<mass value="2"/>', ""),
    "no_inertia_element": changed(' iyz="0" izz="0.05"', ' izz="0.05"'),
    "negative_mass": changed('value="2"', 'value="-2"'),
    "dry_friction_at_every_joint": (
        ARM.replace('<dynamics damping="0.1"/>', "").replace("<axis", '<dynamics friction="2"/> <axis'),
        HEAD,
    ),
    "one_attribute_at_every_joint": (ARM.replace("<axis", '<axis spring="3"'), HEAD),
    "impossible_inertia": changed('izz="0.04"', 'izz="-0.4"'),
}
GROUPS = {"hostile": HOSTILE, "paths": PATHS, "tree": TREE, "joints": JOINTS, "parts": PARTS}
