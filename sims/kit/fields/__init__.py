"""The kinds of fields that a sim's Params are made of.

    yaw: Annotated[float, Slider(-180, 180, step=1, unit="°", title="Yaw", symbol="ψ")] = 30.0
    \"\"\"Angle about Z\"\"\"

What a kind says feeds the page's control, the link, the JSON schema, validation, the docs and the tests. A kind knows
how its values are read from a link, what is allowed in words, and how a live control is kept within bounds.
"""

from sims.kit.fields.kind import Kind
from sims.kit.fields.numbers import NumberBox, Numbers, Numeric, OptionalNumber, Slider, Vector
from sims.kit.fields.words import Choice, Letters, Opened, Switch, Text

__all__ = [
    "Choice",
    "Kind",
    "Letters",
    "NumberBox",
    "Numbers",
    "Numeric",
    "Opened",
    "OptionalNumber",
    "Slider",
    "Switch",
    "Text",
    "Vector",
]
