"""Classes: one teacher, many learners in rooms of their own, and how far each of them is. In memory only."""
