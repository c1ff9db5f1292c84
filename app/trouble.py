"""What goes wrong when somebody's message is obeyed: for them in words and as fields, and a line in the log."""

from __future__ import annotations

import logging
from collections.abc import Iterable, Mapping
from typing import Any

from pydantic import ValidationError

from app.logs import raised_at
from app.rooms.memory import NoRoom
from app.values import complaints, shown
from geometry import GeometryError
from sims.kit.params import Params
from sims.kit.refusals import Complaint
from sims.kit.sim import Sim
from sims.kit.spelling import clipped

log = logging.getLogger("sim3")


class Unknown(KeyError):
    """A name that stands for nothing; `kind` says for what it should."""

    def __init__(self, kind: str, name: str, known: Iterable[str]) -> None:
        super().__init__(name)
        self.words = f"There is no {kind} named {shown(name)}."
        self.complaint = Complaint("name", shown(name), clipped("one of: " + ", ".join(known), 400))


def error_message(
    sim: Sim[Any, Any], error: Exception, given: Mapping[str, Any] | None = None, *, beside: bool = False,
    state: Params | None = None,
) -> dict[str, Any]:  # fmt: skip
    """The message that pages get; `given` are the parameters as they came. What nobody has foreseen is logged.

    The log has the `state` in which that was, as a link has it.

    `beside`: it stands beside the control, and needs neither name nor value.
    """
    if isinstance(error, Unknown):
        return refused(error.words, error.complaint)
    if isinstance(error, ValidationError):
        found = list(complaints(sim.params, given or {}, error))
        said = " ".join(_sentence(complaint, bool(item["loc"])) for item, complaint in found) if beside else ""
        return refused(said, *(complaint for _, complaint in found))
    if isinstance(error, NoRoom):
        return refused(str(error))
    if isinstance(error, GeometryError):
        known = error.argument in (*sim.params.model_fields, "view")
        return refused(str(error), *[Complaint(error.argument, shown(error.received), error.allowed)] * known)
    file, line = raised_at(error.__traceback__)
    where = "here" if state is None else f"?{state.query()}"
    stopped = f"{sim.slug} in {file}, line {line}"  # in one, for lines of another place are others
    log.error("%s, can't go on from %s: %r", stopped, where, error)
    return refused("That went wrong on the server, whose log says how. The state is as it was.")


def _sentence(complaint: Complaint, kind: bool) -> str:
    """What is allowed, as a sentence: of a `kind` of field, or in the words of a sim's own validator."""
    _, _, allowed = complaint
    return f"This needs {allowed}." if kind else f"{allowed[0].upper()}{allowed[1:]}."


def question(complaint: Complaint) -> str:
    """Asks whether something else was meant, where that may be."""
    return f" (did you mean {complaint.meant}?)" if complaint.meant else ""


def refused(words: str, *found: Complaint) -> dict[str, Any]:
    """An error message; without words of its own it says what is wrong with each parameter."""
    fields = [{"parameter": name, "received": received, "allowed": allowed} for name, received, allowed in found]
    said = words or "; ".join(f"{c[0]}: got {c[1]}{question(c)}, allowed: {c[2]}" for c in found)
    return {"type": "error", "message": clipped(said, 400), "errors": fields[:20]}
