"""The mechanism as a picture: links, joints, wheels and points at one configuration, as SVG; places along a motion."""
