"""Confidence intervals of means of a few values."""
import math
import statistics

# 97.5 % points of Student's t for 1, 2, … degrees of freedom.
STUDENT = [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131,
           2.120, 2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042]


def student(freedom):
    return STUDENT[min(freedom, len(STUDENT)) - 1]


def half_interval(values):
    """Half the 95 % confidence interval of the mean of independent values [Student's t]."""
    n = len(values)
    return student(n - 1) * statistics.stdev(values) / math.sqrt(n) if n > 1 else math.nan
