"""Websockets: what may come through them, and what becomes of it."""
