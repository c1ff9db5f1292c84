"""Who made what a server runs, and what it stores."""

from __future__ import annotations

import tomllib
from functools import cache
from typing import NamedTuple

from fastapi import APIRouter, Request
from fastapi.responses import Response

from app.routes import rendering
from app.routes.pages import page
from app.settings import ROOT

router = APIRouter(include_in_schema=False)


class Credit(NamedTuple):
    """A library that the pages or the server are made with."""

    name: str
    use: str
    licence: str
    home: str


CREDITS = (
    Credit("viser", "scenes and their client", "MIT", "https://viser.studio/"),
    Credit("three.js, React and Mantine", "drawing, within viser’s client", "MIT", "https://threejs.org/"),
    Credit("NumPy", "arrays and linear algebra", "BSD-3-Clause", "https://numpy.org/"),
    Credit("SciPy", "neighbours and optimisation", "BSD-3-Clause", "https://scipy.org/"),
    Credit(
        "FastAPI, Starlette and Uvicorn", "pages and addresses", "MIT, BSD-3-Clause", "https://fastapi.tiangolo.com/"
    ),
    Credit(
        "websockets and uvloop", "what is live", "BSD-3-Clause, MIT or Apache-2.0", "https://websockets.readthedocs.io/"
    ),
    Credit("Pydantic", "parameters and settings", "MIT", "https://docs.pydantic.dev/"),
    Credit("msgspec and Zstandard", "messages to the scenes", "BSD-3-Clause", "https://jcristharif.com/msgspec/"),
    Credit("Jinja", "templates", "BSD-3-Clause", "https://jinja.palletsprojects.com/"),
    Credit("markdown-it-py and its plugins", "the text of lessons", "MIT", "https://markdown-it-py.readthedocs.io/"),
    Credit("latex2mathml", "formulas", "MIT", "https://github.com/roniemartinez/latex2mathml"),
    Credit("nbformat", "notebooks", "BSD-3-Clause", "https://nbformat.readthedocs.io/"),
    Credit("segno", "QR codes", "BSD-3-Clause", "https://segno.readthedocs.io/"),
    Credit("trimesh", "bodies and surfaces", "MIT", "https://trimesh.org/"),
    Credit("laspy, lazrs and python-neo-lzf", "files of point clouds", "BSD, MIT", "https://laspy.readthedocs.io/"),
)


@cache
def version() -> str:
    """That of the checkout that is served."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    return str(project["version"])


@page("/about", router)
async def about(request: Request) -> Response:
    return rendering.render(request, "about.html", version=version(), credits=CREDITS)
