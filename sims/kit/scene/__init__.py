"""The 3D scene of one viewer: nodes, the stage that makes them, and bodies that several sims show."""
