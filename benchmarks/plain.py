"""Euler angles as one writes them with viser alone, to compare with; behind the simplest bridge to one port.

Each client has its own handles, each slider an async callback, and each callback assigns everything anew through
viser's handles, with SciPy for the rotations. The scene has the same bodies as the sim: three nested frames, an
aircraft, three arcs with labels, and the numbers beside it.
"""

from __future__ import annotations

import asyncio
import os
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import uvicorn
import viser
import websockets
from scipy.spatial.transform import Rotation
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import FileResponse, PlainTextResponse
from starlette.routing import Route, WebSocketRoute
from starlette.websockets import WebSocket, WebSocketDisconnect

from sims.kit.scene.bodies import aircraft

PAGE = Path(viser.__file__).parent / "client" / "build" / "index.html"
PARENTS = ("/turn1", "/turn1/turn2", "/turn1/turn2/turn3")
BEFORE = ("", *PARENTS[:2])
ORDERS = ("zyx", "xyz", "zxz", "xzy", "yxz", "yzx", "zxy", "xyx", "xzx", "yxy", "yzy", "zyz")
COLORS = {"x": (209, 36, 47), "y": (26, 127, 55), "z": (11, 95, 215)}

server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)


def arc(axis: str, angle: float, radius: float = 1.2) -> npt.NDArray[np.float32]:
    """Segments of an arc about an axis."""
    k = "xyz".index(axis)
    t = np.linspace(0.0, angle, 49)
    points = np.zeros((49, 3), np.float32)
    points[:, (k + 1) % 3] = radius * np.cos(t)
    points[:, (k + 2) % 3] = radius * np.sin(t)
    return np.stack([points[:-1], points[1:]], axis=1)


def table(matrix: npt.NDArray[np.float64]) -> str:
    """A matrix in HTML."""
    rows = "".join("<tr>" + "".join(f"<td>{v:.3f}</td>" for v in row) + "</tr>" for row in matrix)
    return f"<table>{rows}</table>"


@server.on_client_connect
async def _(client: viser.ClientHandle) -> None:
    scene, gui = client.scene, client.gui
    order = gui.add_dropdown("Order", ORDERS)
    sliders = [gui.add_slider(name, -180.0, 180.0, 1.0, start) for name, start in START.items()]
    numbers = gui.add_html("")

    scene.add_grid("/ground", width=6.0, height=6.0, position=(0.0, 0.0, -1.3))
    scene.add_frame("/world", axes_length=1.55, axes_radius=0.008)
    frames = [scene.add_frame(name, axes_length=1.15, axes_radius=0.02) for name in PARENTS]
    body = aircraft()
    for name, color in (("hull", (201, 208, 216)), ("mark", (179, 89, 0))):
        scene.add_mesh_simple(f"{PARENTS[2]}/{name}", body[name].vertices, body[name].faces, color=color)
    arcs = [
        scene.add_line_segments(f"{before}/arc{k}", arc("xyz"[k], 1.0), COLORS["xyz"[k]], thickness=4.0)
        for k, before in enumerate(BEFORE)
    ]
    labels = [scene.add_label(f"{before}/label{k}", "", position=(0.0, 0.0, 1.3)) for k, before in enumerate(BEFORE)]

    async def update(_: Any = None) -> None:
        angles = np.radians([s.value for s in sliders])
        turns = [Rotation.from_euler(axis, a) for axis, a in zip(order.value, angles, strict=True)]
        whole = turns[0] * turns[1] * turns[2]
        for k, turn in enumerate(turns):
            frames[k].wxyz = turn.as_quat(scalar_first=True)
            arcs[k].points = arc(order.value[k], angles[k])
            labels[k].text = f"{sliders[k].label} {sliders[k].value:.0f}°"
        axis_angle = whole.as_rotvec()
        parts = [f"<p>R</p>{table(whole.as_matrix())}"]
        parts += [f"<p>R{a}</p>{table(t.as_matrix())}" for a, t in zip(order.value, turns, strict=True)]
        parts.append("<p>q = " + ", ".join(f"{v:.3f}" for v in whole.as_quat(scalar_first=True)) + "</p>")
        parts.append("<p>θn = " + ", ".join(f"{v:.3f}" for v in axis_angle) + "</p>")
        back = whole.as_euler(order.value.upper(), degrees=True)
        parts.append("<p>read back " + ", ".join(f"{v:.2f}" for v in back) + "</p>")
        numbers.content = f'<div class="numbers">{"".join(parts)}</div>'

    order.on_update(update)
    for slider in sliders:
        slider.on_update(update)
    await update()


START = {"Yaw": 30.0, "Pitch": 20.0, "Roll": 10.0}


async def page(_: Request) -> FileResponse:
    """viser's own page."""
    return FileResponse(PAGE, headers={"cache-control": "no-store"})


async def healthz(_: Request) -> PlainTextResponse:
    return PlainTextResponse("ok")


async def bridge(ws: WebSocket) -> None:
    """Frames both ways, as they are."""
    protocol: Any = ws.scope["subprotocols"][0]
    await ws.accept(subprotocol=protocol)
    address = f"ws://127.0.0.1:{server.get_port()}"
    async with websockets.connect(address, subprotocols=[protocol], compression=None, max_size=None) as inner:

        async def outward() -> None:
            async for data in inner:
                assert isinstance(data, bytes)
                await ws.send_bytes(data)

        sending = asyncio.create_task(outward())
        try:
            while True:
                await inner.send(await ws.receive_bytes())
        except (WebSocketDisconnect, websockets.ConnectionClosed):
            pass
        finally:
            sending.cancel()
            await asyncio.gather(sending, return_exceptions=True)


if __name__ == "__main__":
    routes = [Route("/", page), Route("/healthz", healthz), WebSocketRoute("/", bridge)]
    port = int(os.environ["SIM3_PORT"])
    uvicorn.run(Starlette(routes=routes), host="127.0.0.1", port=port, log_level="error", access_log=False)
