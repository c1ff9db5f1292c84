"""A link's query: the sim's parameters, what every page offers besides, and what others hang on links."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import Any, NamedTuple
from urllib.parse import urlencode

from sims.kit.params import Params
from sims.kit.refusals import BadParams, Complaint
from sims.kit.sim import Sim
from sims.kit.spelling import clipped, meant, number_text

Items = Sequence[tuple[str, str]]
OPTIONS = ("view", "controls", "theme", "only", "challenge", "lesson")
"""What every query may hold besides the sim's parameters."""
TRACKING = re.compile(
    r"(utm|mtm|pk|hsa|matomo|piwik)_\w+|_ga|_gl|_hsenc|_hsmi|_openstat|dclid|fbclid|gad_(source|campaignid)|gbraid|gclid"
    r"|gclsrc|igshid|igsh|li_fat_id|mc_(cid|eid|tc)|mkt_tok|ml_subscriber(_hash)?|msclkid|oly_(anon|enc)_id|s_cid|srsltid"
    r"|ttclid|twclid|vero_id|wbraid|wickedid|yclid",
    re.IGNORECASE,
)
"""Names that mail and advertising programs add to links to follow who clicks on them: they mean nothing here."""


class Parts(NamedTuple):
    """A query that is taken apart, each part in the order in which it was given."""

    params: list[tuple[str, str]]
    options: list[tuple[str, str]]


def parts(items: Items) -> Parts:
    """A query's parameters and its page options; what only follows people is left out."""
    ours = [item for item in items if not TRACKING.fullmatch(item[0])]
    return Parts([item for item in ours if item[0] not in OPTIONS], [item for item in ours if item[0] in OPTIONS])


def read(sim: Sim[Any, Any], items: Items) -> Params:
    """The state that a link names; its page options are checked too. Raises BadParams with all that is wrong."""
    given, options = parts(items)
    wrong = _wrong(sim, options)
    kept = {name: text for name, text in options if name not in {complaint[0] for complaint in wrong}}
    try:
        params: Params = sim.params.from_query(given)
    except BadParams as error:
        raise BadParams([*error.complaints, *wrong], {**error.good, **kept}) from None
    if wrong:
        raise BadParams(wrong, {**dict(given), **kept})
    return params


def own(items: Items) -> str:
    """The query without what only follows people."""
    return spelled(dict([*(taken := parts(items)).params, *taken.options]))


def spelled(query: dict[str, str]) -> str:
    """A query string that people can read."""
    return urlencode(query, safe=",-.:")


def _wrong(sim: Sim[Any, Any], options: Items) -> list[Complaint]:
    complaints = []
    names = [name for name, _ in options]
    for name, text in dict(options).items():
        given = [value for other, value in options if other == name]
        if names.count(name) > 1:
            complaints.append(Complaint(name, clipped(" and ".join(given)), "one value"))
        elif name == "view" and not is_view(text):
            complaints.append(Complaint(name, clipped(text), "six numbers: viewpoint x,y,z and look-at x,y,z"))
        elif name in WORDS and text not in WORDS[name]:
            allowed = " or ".join(WORDS[name])
            complaints.append(Complaint(name, clipped(text), allowed, meant(text, WORDS[name])))
        elif name == "only" and (strange := [each for each in text.split(",") if each not in (known := controls(sim))]):
            allowed = "some of these, with commas between: " + ", ".join(known)
            complaints.append(Complaint(name, clipped(text), allowed, meant(strange[0], known)))
        elif name == "challenge" and text not in (known := [each.id for each in sim.challenges]):
            allowed = "one of: " + ", ".join(known) if known else "nothing: this sim has no challenges"
            complaints.append(Complaint(name, clipped(text), allowed, meant(text, known)))
    return complaints


WORDS = {"theme": ("light", "dark"), "controls": ("1", "0"), "lesson": ("1", "0")}


def controls(sim: Sim[Any, Any]) -> list[str]:
    """What `only` may name: parameters and dials that have a control, and actions."""
    pressed = [name for action in sim.actions for name in action.names]
    return [*sim.params.visible, *(dial.handle for dial in sim.dials), *pressed]


def is_view(text: str) -> bool:
    """Whether a text names a viewpoint and another place that is looked at, in metres."""
    try:
        values = [float(number_text(v)) for v in text.split(",")]
    except ValueError:
        return False
    return len(values) == 6 and all(math.isfinite(v) and abs(v) < 1e4 for v in values) and values[:3] != values[3:]
