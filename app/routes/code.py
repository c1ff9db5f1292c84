"""The scripts of a state, to run anywhere: as they are, or as a notebook."""

from __future__ import annotations

from fastapi import APIRouter, HTTPException, Request
from fastapi.responses import Response

from app import scripts
from app.routes import links
from app.routes.pages import page
from app.routes.rendering import sim_or_404
from app.security import ANYWHERE
from sims.kit.params import Params
from sims.kit.refusals import BadParams, Complaint
from sims.kit.sim import Sim
from sims.kit.spelling import clipped, meant

ASKED = {"lang": scripts.LANGUAGES, "format": ("py", "ipynb")}
"""What the query holds besides a state, and what each may be: the first where nothing is said."""
KINDS = {"py": "text/x-python", "ipynb": "application/x-ipynb+json"}
router = APIRouter(include_in_schema=False)


@page("/sims/{slug}/code", router)
async def code(request: Request, slug: str) -> Response:
    sim = sim_or_404(slug)
    params, asked = _read(sim, request.query_params.multi_items())
    found = scripts.script(sim, asked["lang"])
    if found is None:
        raise HTTPException(404, "This sim has no script.")
    text = scripts.of_state(found, params)
    if asked["format"] == "ipynb":
        query = params.query()
        link = f"{request.base_url}sims/{slug}" + (f"?{query}" if query else "")
        text = scripts.notebook(text, sim.title, link)
    name = f"sim3-{slug}-{found.title.lower()}.{asked['format']}"
    headers = {"content-disposition": f'attachment; filename="{name}"', **ANYWHERE}
    return Response(text, media_type=f"{KINDS[asked['format']]}; charset=utf-8", headers=headers)


def _read(sim: Sim[Params, object], items: links.Items) -> tuple[Params, dict[str, str]]:
    """The state, and which script of it. Raises BadParams with all that is wrong."""
    wrong: list[Complaint] = []
    asked = {name: allowed[0] for name, allowed in ASKED.items()}
    for name, text in items:
        if name in ASKED and text not in ASKED[name]:
            wrong.append(Complaint(name, clipped(text), " or ".join(ASKED[name]), meant(text, ASKED[name])))
        elif name in ASKED:
            asked[name] = text
    try:
        params = links.read(sim, [item for item in items if item[0] not in ASKED])
    except BadParams as error:
        raise BadParams([*wrong, *error.complaints], error.good) from None
    if wrong:
        raise BadParams(wrong, params.query_items())
    return params, asked


def shown(sim: Sim[Params, object], params: Params) -> list[tuple[str, str, str]]:
    """The scripts of a sim in a state: for each what it is asked for by, its library's name, and its text."""
    both = [(language, scripts.script(sim, language)) for language in scripts.LANGUAGES]
    return [(language, found.title, scripts.of_state(found, params)) for language, found in both if found is not None]
