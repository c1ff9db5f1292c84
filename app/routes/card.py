"""What other sites show of a lesson's page: a picture for its link, and its description as schema.org has it."""

from __future__ import annotations

from typing import Any, NamedTuple

from fastapi import Request

from app.lessons.lesson import Lesson
from app.routes.oembed import PICTURE, picture
from app.routes.rendering import AnySim


class Card(NamedTuple):
    """For card.html."""

    picture: str
    size: tuple[int, int]
    resource: dict[str, Any]


def card(request: Request, sim: AnySim, lesson: Lesson | None, path: str) -> Card:
    """The card of a lesson, or of a sim that has none yet."""
    root = str(request.base_url)
    resource = {
        "@context": "https://schema.org", "@type": "LearningResource",
        "name": lesson.title if lesson else sim.title, "description": lesson.summary if lesson else sim.summary,
        "url": f"{root}{path}", "image": picture(root, sim), "inLanguage": "en", "isAccessibleForFree": True,
        "learningResourceType": "simulation", "interactivityType": "active",
        "teaches": [objective.text for objective in sim.objectives], "about": list(sim.concepts),
        "isPartOf": {"@type": "WebSite", "name": "Sim3", "url": root},
    }  # fmt: skip
    if lesson and lesson.minutes:
        resource["timeRequired"] = f"PT{lesson.minutes}M"
    return Card(picture(root, sim), PICTURE, resource)
