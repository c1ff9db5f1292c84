"""Kinds of fields that are numbers: one, one that may be absent, or several."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, replace
from typing import Any, ClassVar, Self, get_args, get_origin

from sims.kit.fields.kind import Kind
from sims.kit.spelling import number_text, spans

Range = tuple[float, float]
"""Least and greatest value."""


@dataclass(frozen=True, kw_only=True)
class Numeric(Kind):
    """What has bounds (inclusive, in `unit`) and a step."""

    step: float
    unit: str = ""

    @property
    @abstractmethod
    def bounds(self) -> Range:
        """Declared least and greatest value; of several entries, those that all are within."""

    @abstractmethod
    def ranges(self, value: Any, bounds: Range) -> Sequence[Range]:
        """Bounds of each number that a value holds, or may hold, where the state's are `bounds`."""

    def entries(self, value: Any) -> tuple[float, ...]:
        """The numbers that a value holds."""
        return () if value is None else (value,)

    def clamped(self, value: Any, ranges: Sequence[Range]) -> Any:
        """The value with each of its numbers within its range."""
        kept = [min(max(v, low), high) for v, (low, high) in self._bounded(value, ranges)]
        return tuple(kept) if isinstance(value, tuple) else kept[0] if kept else None

    def within(self, value: Any, ranges: Sequence[Range]) -> bool:
        return all(low <= v <= high for v, (low, high) in self._bounded(value, ranges))

    def _bounded(self, value: Any, ranges: Sequence[Range]) -> Iterable[tuple[float, Range]]:
        return zip(self.entries(value), ranges, strict=False)  # pydantic judges how many there are


@dataclass(frozen=True)
class Number(Numeric):
    """One number from `low` to `high`; whole where the field's type is int."""

    low: float
    high: float
    _: KW_ONLY
    symbol: str = ""
    whole: bool = False
    hints: ClassVar[tuple[str, ...]] = ("step", "unit", "symbol", "group")

    def of(self, annotation: Any) -> Self:
        return replace(self, whole=int in (annotation, *get_args(annotation)))

    @property
    def bounds(self) -> Range:
        return self.low, self.high

    def ranges(self, value: Any, bounds: Range) -> Sequence[Range]:
        return (bounds,)

    @property
    def allowed(self) -> str:
        return f"a {'whole ' if self.whole else ''}number {spans([self.bounds])}"

    @property
    def label(self) -> str:
        """The title with its symbol, as in "Yaw ψ"."""
        return f"{self.title} {self.symbol}".strip()

    def unspell(self, text: str) -> Any:
        return number_text(text)

    def glides(self, start: Any, end: Any) -> bool:
        """Whole numbers without a slider, such as that of a selected point, are names and no amounts."""
        return isinstance(start, float) and isinstance(end, float)

    def _limits(self) -> Mapping[str, Any]:
        return {"ge": self.low, "le": self.high}


@dataclass(frozen=True)
class Slider(Number):
    """A number that is set by a slider."""

    control: ClassVar[str] = "slider"

    def glides(self, start: Any, end: Any) -> bool:
        return True


@dataclass(frozen=True)
class NumberBox(Number):
    """A number that is typed. One that may be absent (None) has a box that may be empty."""

    control: ClassVar[str] = "number"


@dataclass(frozen=True)
class OptionalNumber(Number):
    """A whole number that may be absent (None). Its dropdown offers `off`, and `words` for each number.

    In `words`, {0} stands for the number and {1} for the next: "{0} ↔ {1}".
    """

    _: KW_ONLY
    words: str
    off: str = "Off"
    step: float = 1
    control: ClassVar[str] = "option"
    hints: ClassVar[tuple[str, ...]] = ("step", "group", "words", "off")

    def options(self, bounds: Range) -> dict[int | None, str]:
        """How each value within a state's bounds is shown."""
        offered = range(int(bounds[0]), int(bounds[1]) + 1)
        return {None: self.off, **{k: self.words.format(k, k + 1) for k in offered}}


@dataclass(frozen=True)
class Several(Numeric):
    """Numbers with commas between them in a link: `1,0.5,2`."""

    @property
    @abstractmethod
    def count(self) -> str:
        """In words: how many."""

    @abstractmethod
    def _declared(self) -> Sequence[Range]: ...

    def entries(self, value: Any) -> tuple[float, ...]:
        return value or ()

    @property
    def allowed(self) -> str:
        return f"{self.count} numbers {spans(self._declared())}, separated by commas"

    @property
    def allowed_in_json(self) -> str:
        return f"a list of {self.count} numbers {spans(self._declared())}"

    def unspell(self, text: str) -> Any:
        return tuple(number_text(text).split(","))

    def glides(self, start: Any, end: Any) -> bool:
        return start is not None and end is not None and len(start) == len(end)


@dataclass(frozen=True)
class Vector(Several):
    """Two or more numbers that belong together, or None.

    `low` and `high` bound every entry, or each its own when they are tuples. `presets` are values to choose from.
    """

    low: float | tuple[float, ...]
    high: float | tuple[float, ...]
    _: KW_ONLY
    presets: Mapping[str, tuple[float, ...]] | None = None
    each: tuple[Range, ...] = ()
    """Bounds of each entry, as they follow with the field's type."""
    control: ClassVar[str] = "vector"
    hints: ClassVar[tuple[str, ...]] = ("step", "unit", "group", "low", "high", "presets")

    def of(self, annotation: Any) -> Self:
        (vector,) = [kind for kind in (annotation, *get_args(annotation)) if get_origin(kind) is tuple]
        size = len(get_args(vector))
        low, high = (v if isinstance(v, tuple) else (v,) * size for v in (self.low, self.high))
        if not len(low) == len(high) == size:
            raise TypeError(f"low and high must be one number, or {size} numbers, got {self.low} and {self.high}")
        return replace(self, each=tuple(zip(low, high, strict=True)))

    @property
    def bounds(self) -> Range:
        return min(low for low, _ in self.each), max(high for _, high in self.each)

    def ranges(self, value: Any, bounds: Range) -> Sequence[Range]:
        return self.each

    @property
    def count(self) -> str:
        return str(len(self.each))

    def _declared(self) -> Sequence[Range]:
        return self.each


@dataclass(frozen=True)
class Numbers(Several):
    """A list of `least` to `most` numbers, each with a slider that is called as `entry` says: "Joint {} angle"."""

    low: float
    high: float
    _: KW_ONLY
    most: int
    least: int = 1
    entry: str = ""
    control: ClassVar[str] = "numbers"
    hints: ClassVar[tuple[str, ...]] = ("step", "unit", "group", "low", "high", "most", "least", "entry")

    @property
    def bounds(self) -> Range:
        return self.low, self.high

    def ranges(self, value: Any, bounds: Range) -> Sequence[Range]:
        return (bounds,) * len(value)

    @property
    def count(self) -> str:
        return f"{self.least} to {self.most}"

    def _declared(self) -> Sequence[Range]:
        return [self.bounds]

    def unspell(self, text: str) -> Any:
        return super().unspell(text) if text or self.least else ()

    def _limits(self) -> Mapping[str, Any]:
        return {"min_length": self.least, "max_length": self.most}
