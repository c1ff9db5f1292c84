"""What the sims share: parameters, controls, scenes, image panes, read-outs."""
