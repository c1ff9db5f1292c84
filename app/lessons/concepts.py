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
MEANINGS = {
    "coordinate-system": "Three axes and an origin: what gives every place three numbers.",
    "homogeneous-coordinates": "A fourth number w: one matrix then turns and moves, and points differ from directions.",
    "euler-angles": "Three turns about three axes, one after the other, that make any rotation.",
    "gimbal-lock": "Where two of three turning axes become one, and a way to turn is lost.",
    "quaternion": "Four numbers that hold a rotation’s axis and half of its angle.",
    "quaternion-rotation": "q p q*: how a quaternion turns a point, from both sides.",
    "rigid-body-transform": "A turn and a move together: all lengths and angles stay.",
    "se3": "All rigid transforms, which can be chained and undone: 4×4 matrices in which order counts.",
    "perspective-projection": "Places along one line of sight become one pixel; what is farther away becomes smaller.",
    "intrinsic-parameters": "What belongs to the camera itself: focal length, principal point and skew.",
    "extrinsic-parameters": "Where the camera stands and how it is turned: R and t.",
    "camera-matrix": "K, the matrix of the intrinsic parameters: from the camera’s axes to pixels.",
    "projection-matrix": "P = K [R | t]: from a place in the world to its pixel, in one matrix.",
    "epipolar-geometry": "How two pictures of one scene are bound together: a point in one is a line in the other.",
    "stereo-vision": "Depth from two eyes: the nearer a thing is, the more it shifts between them.",
    "triangulation": "Where two lines of sight meet, or nearly do, there is the place.",
    "point-cloud": "A scene as very many measured points, with colour, intensity or normals.",
}
"""What each is, in a sentence."""
