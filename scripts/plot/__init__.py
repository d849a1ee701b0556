"""Plots of a run directory, used by scripts/report.py."""
