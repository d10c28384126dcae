"""Which parameters of its bodies a mechanism shows, and what a log of the machine says of them."""
