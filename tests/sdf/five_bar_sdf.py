"""The machine of models/five_bar.urdf as an SDF, whose spindle is a joint as the others are."""

from __future__ import annotations

INERTIAL = """\
<inertial><pose>{com}</pose><mass>{mass}</mass><inertia><ixx>{moments[0]}</ixx><iyy>{moments[1]}</iyy>\
<izz>{moments[2]}</izz></inertia></inertial>"""
CRANK = INERTIAL.format(com="0.07 0 0 0 0 0", mass=0.35, moments=("0.00012", "0.00095", "0.001"))
ROD = INERTIAL.format(com="0.11 0 0 0 0 0", mass=0.22, moments=("0.00005", "0.0011", "0.00112"))
NOTHING = INERTIAL.format(com="0 0 0 0 0 0", mass=0, moments=(0, 0, 0))
END = INERTIAL.format(com="0 0 0 0 0 0", mass=0.4, moments=("0.0004", "0.0004", "0.0002"))


def _joint(name: str, parent: str, child: str, limits: str, dynamics: str) -> str:
    lower, upper, velocity = limits.split()
    return (
        f'<joint name="{name}" type="revolute"><parent>{parent}</parent><child>{child}</child>'
        f"<axis><xyz>0 0 1</xyz><limit><lower>{lower}</lower><upper>{upper}</upper><velocity>{velocity}</velocity>"
        f"</limit><dynamics>{dynamics}</dynamics></axis></joint>\n"
    )


def five_bar(spindle: str) -> str:
    """The file; `spindle` is the joint of both ends."""
    motor, elbow = "<damping>0.02</damping><friction>0.05</friction>", "<damping>0.002</damping>"
    return f"""\
<?xml version="1.0"?>
<sdf version="1.9">
<model name="five_bar">
  <link name="base"/>
  <link name="left_crank"><pose>-0.06 0 0.2 0 0 0</pose>{CRANK}</link>
  <link name="right_crank"><pose>0.06 0 0.2 0 0 0</pose>{CRANK}</link>
  <link name="left_rod"><pose relative_to="left_crank">0.16 0 0.02 0 0 0</pose>{ROD}</link>
  <link name="right_rod"><pose relative_to="right_crank">0.16 0 0.02 0 0 0</pose>{ROD}</link>
  <link name="left_end"><pose relative_to="left_rod">0.22 0 0 0 0 0</pose>{NOTHING}</link>
  <link name="right_end"><pose relative_to="right_rod">0.22 0 0 0 0 0</pose>{END}</link>
  <joint name="fixed" type="fixed"><parent>world</parent><child>base</child></joint>
{_joint("left_motor", "base", "left_crank", "0.8 3.3 12", motor)}\
{_joint("right_motor", "base", "right_crank", "-0.2 2.3 12", motor)}\
{_joint("left_elbow", "left_crank", "left_rod", "-2.8 -0.3 20", elbow)}\
{_joint("right_elbow", "right_crank", "right_rod", "0.3 2.8 20", elbow)}\
  <joint name="left_flange" type="fixed"><parent>left_rod</parent><child>left_end</child></joint>
  <joint name="right_flange" type="fixed"><parent>right_rod</parent><child>right_end</child></joint>
  {spindle}
</model>
</sdf>
"""
