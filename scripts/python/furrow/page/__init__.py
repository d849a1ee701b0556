"""The page `report.html`: one file that shows what a folder of results holds, in any browser and without a network."""
from .write import compare, write  # noqa: F401
