"""Rooms: running sims, each with its state, those who look at it, and what works for it."""
