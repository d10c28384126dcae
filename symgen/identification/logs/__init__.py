"""Logs of machines: read with all their mistakes, filtered, differentiated, completed to admissible motions."""
