"""Soft light from above, in place of viser's own lights."""

from __future__ import annotations

from typing import Any


def light(scene: Any) -> None:
    """Light a scene so that surfaces show in the colours that the palette sends."""
    scene.configure_default_lights(enabled=False)
    # viser's default map costs a machine without a GPU 10 s at each opening, and bleaches every colour.
    scene.configure_environment_map(None)
    scene.add_light_hemisphere("/sky", sky_color=(255, 255, 255), ground_color=(150, 158, 168), intensity=2.6)
    scene.add_light_directional("/sun", intensity=1.2, position=(2.0, -3.0, 6.0))
