"""How Hypothesis runs here: enough examples to find a slip, few enough to run at every save."""

from hypothesis import settings

settings.register_profile("geometry", deadline=None, max_examples=40, database=None)
settings.load_profile("geometry")
