"""The generated C on emulated microcontrollers: the same bits as on the host, its cost and its footprint."""
