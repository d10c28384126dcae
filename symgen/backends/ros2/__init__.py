"""ROS 2: a package with the C behind the community's interface of inverse dynamics."""
