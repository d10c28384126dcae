"""Points of the constraint manifold for the reference: loops closed, branches, what is measured or planned."""
