"""MJCF files written by hand, and models that name them."""

from __future__ import annotations

from pathlib import Path

from symgen.model.load import load_text
from symgen.model.model import Model

HEAD = "model: robot\nmjcf: {file: robot.xml, friction_width: 0.01}\n"
# every kind of joint, several in one body, turns of every kind, masses of geoms, classes, frames
TREE = """\
<mujoco model="tree">
  <compiler angle="degree" eulerseq="zYx"/>
  <option gravity="0.3 -0.2 -9.5"/>
  <default>
    <joint damping="0.2" armature="0.03"/>
    <default class="big">
      <geom type="capsule" size="0.05 0.2" density="700"/>
      <default class="small"><geom size="0.02 0.1"/></default>
    </default>
  </default>
  <worldbody>
    <geom type="plane" size="1 1 1"/>
    <body name="base" pos="0.1 0.2 0.3" euler="10 20 30">
      <joint name="turn" axis="0 0.6 0.8" pos="0.1 0 0.05" ref="20" range="-90 90" stiffness="3" springref="10"/>
      <joint name="slide" type="slide" axis="1 1 0" ref="0.1" stiffness="40"/>
      <geom class="big"/>
      <geom type="box" size="0.1 0.2 0.3" pos="0.1 0 0" quat="1 2 3 4" mass="2"/>
      <body name="arm" childclass="big" pos="0 0 0.4" axisangle="1 1 0 40">
        <joint name="ball" type="ball" pos="0 0.1 0" damping="0" armature="0"/>
        <geom fromto="0 0 0 0.3 0.2 0.1"/>
        <geom class="small" pos="0 0 0.3"/>
        <geom type="ellipsoid" size="0.1 0.05 0.08" pos="0.3 0 0"/>
        <frame pos="0.1 0.2 0" euler="0 30 0">
          <body name="tool" pos="0.2 0 0" xyaxes="1 0.2 0 0 1 0.3">
            <inertial mass="0.7" pos="0.05 0.01 0" fullinertia="0.01 0.012 0.014 0.001 0.002 -0.001"/>
            <joint name="wrist" axis="1 0 0"/>
            <body name="finger" zaxis="1 0 1"><geom type="cylinder" size="0.02 0.1"/></body>
          </body>
        </frame>
      </body>
    </body>
    <body name="stone" pos="1 0 1" euler="0 90 0">
      <freejoint name="fly"/>
      <geom size="0.1"/>
      <geom type="box" size="0.02" fromto="0 0 0 0 0.1 0.2"/>
    </body>
  </worldbody>
</mujoco>
"""
RADIANS = """\
<mujoco>
  <compiler angle="radian" eulerseq="XYZ" inertiafromgeom="true"/>
  <worldbody>
    <body name="one" pos="0 0 1" euler="0.1 0.2 0.3">
      <joint name="a" type="hinge" axis="0 0 1" ref="0.4"/>
      <inertial mass="99" pos="0 0 0" diaginertia="1 1 1"/>
      <geom type="cylinder" size="0.03 0.2" pos="0.1 0 0" euler="0.4 0.1 0.2"/>
      <geom type="ellipsoid" size="0.03 0.02 0.1" density="3000"/>
      <body name="two" pos="0.3 0 0" quat="0.7071068 0 0.7071068 0">
        <joint name="b" type="hinge" axis="1 0 0"/>
        <joint name="c" type="hinge" axis="0 1 0" pos="0 0 0.1"/>
        <joint name="d" type="slide" axis="0 0 2"/>
        <geom type="sphere" size="0.06" pos="0 0.1 0"/>
      </body>
    </body>
  </worldbody>
</mujoco>
"""
FOUR_BAR = """\
<mujoco model="four_bar">
  <compiler angle="radian"/>
  <worldbody>
    <body name="crank" pos="-0.3 0 0.5">
      <joint name="a" axis="0 1 0" ref="0.2"/>
      <geom type="capsule" size="0.02" fromto="0 0 0 0 0 0.3"/>
      <body name="coupler" pos="0 0 0.3">
        <joint name="b" axis="0 1 0"/>
        <geom type="capsule" size="0.02" fromto="0 0 0 0.5 0 0.1"/>
      </body>
    </body>
    <body name="rocker" pos="0.25 0 0.5">
      <joint name="c" axis="0 1 0"/>
      <geom type="capsule" size="0.02" fromto="0 0 0 -0.05 0 0.4"/>
    </body>
  </worldbody>
  <equality><connect name="pin" body1="coupler" body2="rocker" anchor="0.5 0 0.1"/></equality>
  <actuator><motor name="drive" joint="a" gear="2"/></actuator>
</mujoco>
"""
# two arms whose ends are tied in space: a point, a weld, and sites that meet where the machine does not begin
TIED = """\
<mujoco>
  <compiler angle="radian"/>
  <worldbody>
    <body name="left">
      <joint name="a" axis="0 0 1" ref="0.3"/><joint name="b" axis="0 1 0" ref="-0.2"/><joint name="c" axis="1 0 0"/>
      <geom size="0.1" pos="0.3 0 0"/><site name="s" pos="0.4 0.1 0" euler="0.1 0.2 0.3"/>
      <body name="hand" pos="0.4 0.1 0"><joint name="d" axis="0 1 0"/><geom size="0.05"/></body>
    </body>
    <body name="right" pos="1 0 0" euler="0 0 0.4">
      <joint name="e" axis="0 0 1"/><joint name="f" axis="0 1 0" ref="0.5"/><joint name="g" type="slide" axis="1 0 0"/>
      <geom size="0.1" pos="-0.3 0 0"/>
      <body name="ball" pos="-0.4 0.2 0"><joint name="h" type="ball"/><geom size="0.07" pos="0.1 0 0"/></body>
    </body>
  </worldbody>
  <equality>{equality}</equality>
</mujoco>
"""
COUPLED = """\
<mujoco>
  <worldbody>
    <body name="one"><joint name="a" axis="0 0 1" ref="10"/><geom size="0.1" pos="0.2 0 0"/></body>
    <body name="two"><joint name="b" axis="0 1 0" ref="-20"/><geom size="0.1" pos="0.2 0 0"/></body>
    <body name="three"><joint name="c" type="slide" ref="0.1"/><geom size="0.1"/></body>
  </worldbody>
  <equality>
    <joint name="gear" joint1="a" joint2="b" polycoef="0.1 -2.5 0 0 0"/>
    <joint name="cam" joint1="c" joint2="b" polycoef="0.05 0.2 0.3 -0.1 0.4"/>
  </equality>
</mujoco>
"""


def load(folder: Path, robot: str, model: str = HEAD) -> Model:
    """The model with that MJCF file beside it."""
    (folder / "robot.xml").write_text(robot, encoding="utf-8")
    return load_text(model, str(folder / "robot.yaml"))
