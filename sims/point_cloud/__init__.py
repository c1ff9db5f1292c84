"""point-cloud: clouds of points, their attributes, and the operations everybody uses on them."""
