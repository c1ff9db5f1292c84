"""What other people's pages rely on: names of parameters and solution fields, and a link per sim.

A name may be added; one that stands here may not go or change (a renamed parameter keeps the old name as an alias).
"""

from __future__ import annotations

from typing import Any

PARAMETERS: dict[str, str] = {
    "coordinate-frames": "convention to handedness point w grid_xy grid_xz grid_yz show_rule",
    "euler-angles": "order frame yaw pitch roll progress",
    "gimbal-lock": "yaw pitch roll",
    "quaternion": "axis angle start t interpolation long_way show_euler point",
    "transform-chain": "angles lengths axes show swap",
    "camera": "fx fy cx cy skew position pan tilt roll projection show_rays show_frustum",
    "epipolar": "left right left_pan right_pan focal point points show_plane show_all_lines pick",
    "triangulation": "baseline focal left_uv right_uv noise seed method",
    "point-cloud": "dataset color point_size voxel_size show_normals neighbors show_box selected process step",
}

SOLUTION: dict[str, str] = {
    "coordinate-frames": "basis handedness point_world coordinates matrix determinant homogeneous cartesian",
    "euler-angles": "R factors quaternion axis_angle lock_distance locked",
    "gimbal-lock": "R axes singular_values dof lost_axis conditioning",
    "quaternion": "q q_total R_total euler rotated_point interpolated sandwich",
    "transform-chain": "individual composed end_effector inverse positions swapped_end_effector",
    "camera": "K R t P center fov_x fov_y points",
    "epipolar": "K P_left P_right F E rank singular_values epipole_left epipole_right epipole_left_pixel"
    " epipole_right_pixel pixel_left pixel_right line_left line_right residual sampson",
    "triangulation": "point by_method ray_gap closest_points disparity depth_from_disparity covariance"
    " ellipsoid_axes parallax_angle in_front",
    "point-cloud": "points_in points_out minimum maximum dimensions selected",
}

# One link per sim as it stands in course pages, and what it has always meant.
GOLDEN: dict[str, tuple[str, dict[str, Any]]] = {
    "coordinate-frames": (
        "convention=ros&to=camera&handedness=left&point=2,-1,0.5&w=0.5&grid_xy=1&grid_yz=1&show_rule=0",
        {
            "convention": "ros",
            "to": "camera",
            "handedness": "left",
            "point": [2.0, -1.0, 0.5],
            "w": 0.5,
            "grid_xy": True,
            "grid_xz": False,
            "grid_yz": True,
            "show_rule": False,
        },
    ),
    "euler-angles": (
        "order=zxz&frame=extrinsic&yaw=-120.5&pitch=90&roll=45&progress=1.5",
        {"order": "zxz", "frame": "extrinsic", "yaw": -120.5, "pitch": 90.0, "roll": 45.0, "progress": 1.5},
    ),
    "gimbal-lock": (
        "yaw=-30&pitch=90&roll=45.5",
        {"yaw": -30.0, "pitch": 90.0, "roll": 45.5},
    ),
    "camera": (
        "fx=800&fy=700&cx=300&cy=200&skew=10&position=1,-5.5,2&pan=20&tilt=-10&roll=5&projection=weak"
        "&show_rays=0&show_frustum=0",
        {
            "fx": 800.0,
            "fy": 700.0,
            "cx": 300.0,
            "cy": 200.0,
            "skew": 10.0,
            "position": [1.0, -5.5, 2.0],
            "pan": 20.0,
            "tilt": -10.0,
            "roll": 5.0,
            "projection": "weak",
            "show_rays": False,
            "show_frustum": False,
        },
    ),
    "quaternion": (
        "axis=1,1,0&angle=120&start=0.5,0.5,0.5,0.5&t=0.25&interpolation=nlerp&long_way=1&show_euler=1&point=0,1,0.5",
        {
            "axis": [1.0, 1.0, 0.0],
            "angle": 120.0,
            "start": [0.5, 0.5, 0.5, 0.5],
            "t": 0.25,
            "interpolation": "nlerp",
            "long_way": True,
            "show_euler": True,
            "point": [0.0, 1.0, 0.5],
        },
    ),
    "transform-chain": (
        "show=composed&angles=30,40,-30.5,90&lengths=1,0.8,0.5,0&axes=zyyx&swap=2",
        {
            "show": "composed",
            "angles": [30.0, 40.0, -30.5, 90.0],
            "lengths": [1.0, 0.8, 0.5, 0.0],
            "axes": "zyyx",
            "swap": 2,
        },
    ),
    "epipolar": (
        "left=-0.5,0,1.2&right=0.5,0.1,1&left_pan=-10&right_pan=12.5&focal=700&point=0.2,3.5,1.1&points=9&show_plane=0"
        "&show_all_lines=1&pick=right:300,200.5",
        {
            "left": [-0.5, 0.0, 1.2],
            "right": [0.5, 0.1, 1.0],
            "left_pan": -10.0,
            "right_pan": 12.5,
            "focal": 700.0,
            "point": [0.2, 3.5, 1.1],
            "points": 9,
            "show_plane": False,
            "show_all_lines": True,
            "pick": "right:300,200.5",
        },
    ),
    "triangulation": (
        "baseline=1.2&focal=800&left_uv=400,200&right_uv=300,201.5&noise=0.5&seed=7&method=optimal",
        {
            "baseline": 1.2,
            "focal": 800.0,
            "left_uv": [400.0, 200.0],
            "right_uv": [300.0, 201.5],
            "noise": 0.5,
            "seed": 7,
            "method": "optimal",
        },
    ),
    "point-cloud": (
        "dataset=statue&color=height&point_size=3&voxel_size=0.05&show_normals=1&neighbors=20&show_box=0&selected=12"
        "&process=outliers&step=1",
        {
            "dataset": "statue",
            "color": "height",
            "point_size": 3.0,
            "voxel_size": 0.05,
            "show_normals": True,
            "neighbors": 20,
            "show_box": False,
            "selected": 12,
            "process": "outliers",
            "step": 1,
        },
    ),
}
