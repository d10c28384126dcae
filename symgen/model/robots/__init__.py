"""What readers of URDF, MJCF and SDF share: XML, numbers, names, and a tree of links with loops as blocks."""
