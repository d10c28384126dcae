"""Published methods, long or less accurate: to be compared with, and where verification rejects all others, taken."""
