"""The API: the catalogue, and solving. Pages of any origin may ask; what is wrong is said in words and as fields."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any, get_type_hints

import msgspec
from fastapi import APIRouter, HTTPException, Request
from fastapi.responses import Response
from pydantic import ValidationError
from starlette.middleware.cors import CORSMiddleware
from starlette.types import ASGIApp, Receive, Scope, Send

from app.routes.answers import RETRY, Busy, found_for
from app.routes.rendering import sim_or_404
from app.routes.services import Given, Services
from app.security import ANYWHERE
from app.trouble import question
from app.values import complaints, shown, strict
from geometry import GeometryError
from sims import SIMS
from sims.kit.challenge import checked, told
from sims.kit.params import Params
from sims.kit.schema import solution_schema
from sims.kit.sim import Sim, jsonable

AnySim = Sim[Any, Any]


class Json(Response):
    """JSON that any text can be put in: half a surrogate pair isn't UTF-8, so all is escaped that isn't ASCII."""

    media_type = "application/json"

    def render(self, content: Any) -> bytes:
        return json.dumps(content, allow_nan=False).encode("ascii")


class OpenApi:
    """Lets pages of any origin read the API, its errors too, and nothing else."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app
        self._open = CORSMiddleware(
            app, allow_origins=["*"], allow_methods=["GET", "POST"], allow_headers=["*"],
            expose_headers=["retry-after"], max_age=86_400,
        )  # fmt: skip

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        await (self._open if in_api(scope) else self._app)(scope, receive, send)


def in_api(scope: Scope) -> bool:
    """Whether a request is for the API."""
    path = str(scope.get("path", "")).removeprefix(scope.get("root_path", ""))
    return scope["type"] == "http" and path.startswith("/api/")


class BadBody(Exception):
    """What is wrong with a body: items in FastAPI's form, each with `parameter`, `received` and `allowed` besides."""

    def __init__(self, *items: Mapping[str, Any]) -> None:
        super().__init__()
        self.items = items


def read(request: Request, body: bytes, model: type[Params]) -> Params:
    """The parameters in a body; without one, the defaults. Raises `BadBody`."""
    kind = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if body and kind != "application/json" and not (kind.startswith("application/") and kind.endswith("+json")):
        words = f"The body must be JSON, with the header Content-Type: application/json; this one is {kind[:80]!r}."
        raise HTTPException(415, words)
    given = _given(body, model)
    try:
        return strict(model, given)
    except ValidationError as error:
        raise BadBody(
            *(
                _item(item["type"], item["loc"], item["msg"] + question(complaint), item["input"], *complaint)
                for item, complaint in complaints(model, given, error)
            )
        ) from None


def _given(body: bytes, model: type[Params]) -> Mapping[str, Any]:
    try:
        given = json.loads(body, object_pairs_hook=_once) if body else {}
    except RecursionError:
        raise BadBody(_item("json_invalid", (), "The body is nested too deeply", None)) from None
    except Twice as error:
        name = str(error)
        item = _item("twice", (name,), f"{name} is given twice", None, name, "two values", "one value")
        raise BadBody(item) from None
    except ValueError as error:
        raise BadBody(_item("json_invalid", (), f"The body isn't JSON: {error}", None)) from None
    if given is None:
        return {}
    if not isinstance(given, dict):
        raise BadBody(_item("dict_type", (), "The body should be an object of parameters", given, "", shown(given)))
    return given


class Twice(Exception):
    """A name that an object holds more than once."""


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    made = dict(pairs)
    if len(made) < len(pairs):
        names = [name for name, _ in pairs]
        raise Twice(next(name for name in names if names.count(name) > 1))
    return made


def _item(
    kind: str, where: tuple[int | str, ...], words: str, value: Any, parameter: str = "", received: str = "",
    allowed: str = "a JSON object of parameters",
) -> dict[str, Any]:  # fmt: skip
    entries = value if isinstance(value, list | tuple) else (value,)
    flat = not any(isinstance(entry, list | tuple | Mapping) for entry in entries)  # what is nested may be so deeply
    return {
        "type": kind, "loc": ["body", *where], "msg": words, "input": jsonable(value) if flat else shown(value),
        "parameter": parameter, "received": received, "allowed": allowed,
    }  # fmt: skip


router = APIRouter()


@router.head("/api/sims", include_in_schema=False)
@router.get("/api/sims", tags=["catalogue"])
async def catalogue() -> list[dict[str, Any]]:
    """Every sim with its title, summary and concepts."""
    return [_card(sim) for sim in SIMS]


@router.head("/api/sims/{slug}", include_in_schema=False)
@router.get("/api/sims/{slug}", tags=["catalogue"])
async def one(slug: str, given: Given) -> dict[str, Any]:
    """One sim, with its objectives, challenges, the steps of its lesson, and the schemas of parameters and solution."""
    sim = sim_or_404(slug)
    lesson = await given.lessons.soon(sim)
    steps = [] if lesson is None else lesson.steps
    return {
        **_details(sim), "solution": solution_schema(solved(sim)),
        "steps": [{"id": step.id, "title": step.title, "query": step.state.link} for step in steps],
    }  # fmt: skip


def _card(sim: AnySim) -> dict[str, Any]:
    return {"slug": sim.slug, "title": sim.title, "summary": sim.summary, "concepts": list(sim.concepts)}


def _details(sim: AnySim) -> dict[str, Any]:
    return {
        **_card(sim),
        "objectives": [{"text": o.text, "level": o.level} for o in sim.objectives],
        "actions": [{"name": a.name, "label": a.label} for a in sim.actions],
        "challenges": told(sim.challenges),
        "parameters": sim.params.model_json_schema(),
    }


async def bad_body(_: Request, error: Exception) -> Response:
    """The answer to a `BadBody`."""
    assert isinstance(error, BadBody)
    return Json({"detail": error.items}, 422)


async def busy(_: Request, error: Exception) -> Response:
    """The answer to a `Busy`."""
    assert isinstance(error, Busy)
    return Json({"detail": str(error)}, error.status, headers={"retry-after": str(RETRY)})


async def gone(_: Request, error: Exception) -> Response:
    """The answer to a `Gone`, which nobody reads."""
    return Response(status_code=499)


async def failed(request: Request, error: Exception) -> Response:
    """The answer where something went wrong that nobody has foreseen."""
    headers = ANYWHERE if in_api(request.scope) else None  # no middleware sees this answer
    return Json({"detail": "Something went wrong on the server; its log says what."}, 500, headers=headers)


def solved(sim: AnySim) -> type:
    """The dataclass of a sim's solutions."""
    kind: type = get_type_hints(sim.solve)["return"]
    return kind


async def _answered(
    request: Request, given: Services, sim: AnySim, say: Callable[[Params, Any], Mapping[str, Any]]
) -> Response:
    """The answer that a solved body leads to. Raises `BadBody`."""
    params = read(request, await request.body(), sim.params)

    def answer() -> bytes:
        return msgspec.json.encode(say(params, sim.solve(params, *given.sessions.given(sim))))

    try:
        found = await found_for(request, given.answers, answer) if sim.heavy else answer()
    except GeometryError as error:
        known = error.argument if error.argument in sim.params.model_fields else ""
        item = _item("geometry", (), str(error), None, known, shown(error.received), error.allowed)
        raise BadBody(item) from None
    return Response(found, media_type="application/json")


def _add_solve(sim: AnySim) -> None:
    async def solve(request: Request, given: Given) -> Response:
        return await _answered(request, given, sim, lambda params, solution: {
            "params": params.model_dump(mode="json"), "solution": jsonable(solution),
        })  # fmt: skip

    solve.__name__ = f"solve_{sim.slug.replace('-', '_')}"
    solve.__doc__ = f"Solve {sim.title} for some parameters; what is left out is at its default."
    router.post(_solve_path(sim), tags=["solve"], response_class=Response)(solve)


def _solve_path(sim: AnySim) -> str:
    return f"/api/sims/{sim.slug}/solve"


def describe(schema: Mapping[str, Any]) -> None:
    """Put into an OpenAPI schema what each sim takes and answers: found out when it is asked for, not at each start."""
    for sim in SIMS:
        operation = schema["paths"][_solve_path(sim)]["post"]
        operation["requestBody"] = {"content": {"application/json": {"schema": sim.params.model_json_schema()}}}
        operation["responses"] = _responses(sim)


def _responses(sim: AnySim) -> dict[str, dict[str, Any]]:
    schemas = {"params": sim.params.model_json_schema(mode="serialization"), "solution": solution_schema(solved(sim))}
    answer = {"type": "object", "properties": schemas, "required": list(schemas), "additionalProperties": False}
    text = {"type": "string"}
    fields = {**dict.fromkeys(("type", "msg", "parameter", "received", "allowed"), text), "loc": {"type": "array"}}
    item = {"type": "object", "properties": {**fields, "input": {}}, "required": [*fields, "input"]}
    detail = {"type": "object", "properties": {"detail": {"type": "array", "items": item}}}
    return {
        "200": _response("The state, and what follows from it", answer),
        "415": _response("The body isn't JSON"),
        "422": _response("What is wrong, parameter by parameter", detail),
        "429": _response("This address waits for too many long answers already"),
        "503": _response("The server has too much to do, or this took too long"),
    }


def _response(words: str, schema: Mapping[str, Any] | None = None) -> dict[str, Any]:
    plain = {"type": "object", "properties": {"detail": {"type": "string"}}}
    return {"description": words, "content": {"application/json": {"schema": schema or plain}}}


for _sim in SIMS:
    _add_solve(_sim)


@router.post("/api/sims/{slug}/check", tags=["solve"], response_class=Response)
async def check(request: Request, given: Given, slug: str) -> Response:
    """Say how near some parameters are to each challenge of a sim; what is left out is at its default."""
    sim = sim_or_404(slug)
    return await _answered(
        request, given, sim, lambda params, solution: {"challenges": checked(sim.challenges, params, solution)}
    )


@router.post("/api/sims/{slug}/solve", include_in_schema=False)
async def unknown(slug: str) -> None:
    sim_or_404(slug)
