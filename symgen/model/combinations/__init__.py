"""Which combinations of inertial parameters a mechanism shows: ranks in balls, closed forms in its geometry."""
