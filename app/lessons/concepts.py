"""The concepts of the course, in the order in which they are learnt."""

from __future__ import annotations

CONCEPTS = {
    "coordinate-system": "3D coordinate system",
    "homogeneous-coordinates": "Homogeneous coordinates",
    "euler-angles": "Euler angles",
    "gimbal-lock": "Gimbal lock",
    "quaternion": "Quaternion",
    "quaternion-rotation": "Quaternion rotation",
    "rigid-body-transform": "Rigid body transform",
    "se3": "SE(3)",
    "perspective-projection": "Perspective projection",
    "intrinsic-parameters": "Intrinsic parameters",
    "extrinsic-parameters": "Extrinsic parameters",
    "camera-matrix": "Camera matrix",
    "projection-matrix": "Projection matrix",
    "epipolar-geometry": "Epipolar geometry",
    "stereo-vision": "Stereo vision",
    "triangulation": "Triangulation",
    "point-cloud": "Point cloud",
}
"""Each has one place in one lesson, marked as {concept:…} there."""
