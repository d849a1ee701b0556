"""Plots of a run directory, as pictures."""
