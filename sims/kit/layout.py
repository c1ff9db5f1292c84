"""How the page of a sim is laid out, in numbers: the server, the page's scripts and its styles have them from here."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Layout:
    """All lengths in pixels of the page."""

    phone: int = 576
    """Widest page on which viser's panel is a sheet at the bottom."""
    narrow: int = 900
    """Width below which there is less room for panels."""
    low: int = 500
    """Height below which a bottom sheet has room for one thing."""
    flat: int = 760
    """Height below which pictures stand side by side."""
    panel: int = 340
    narrow_panel: int = 300
    """Widths of the panel of the controls."""
    pictures: int = 330
    """Width of the panel of the pictures."""
    field: float = 0.7
    """Vertical field of view of the scene, in radians."""
    sheet: float = 0.55
    """Share of a phone's height that viser's bottom sheet leaves free."""
    lower: float = 0.75
    """Radii that a phone's scene is looked at below its middle, so that it stands above the sheet."""


LAYOUT = Layout()
