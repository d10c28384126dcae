"""Which parameters of its bodies a mechanism shows, and how."""
