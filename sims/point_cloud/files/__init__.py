"""Reading a learner's own cloud: PLY, XYZ and CSV, PCD, LAS and LAZ.

A file comes from anybody. What its header claims is checked against what is there before anything is made room for,
and whatever is wrong with it is a `CloudFileError` in words for the learner.
"""

from sims.point_cloud.files.columns import CloudFileError
from sims.point_cloud.files.ply import ply_bytes
from sims.point_cloud.files.reading import FORMATS, read

__all__ = ["FORMATS", "CloudFileError", "ply_bytes", "read"]
