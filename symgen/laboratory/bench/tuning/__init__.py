"""What passes, constants and what systems do not need are worth, counted."""
