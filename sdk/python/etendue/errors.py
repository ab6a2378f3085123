"""What this package raises, and what it warns of."""

from collections.abc import Sequence


class Error(ValueError):
    """Why a call gave no result: what was expected, and what was found.

    code: a stable upper-case name, "TEMPERATURE_OUT_OF_RANGE".
    text: one sentence.
    hint: what to do about it, or "".
    field: the parameter that it is about, or "".
    index: the place in an array of the first element that it is about; () for a number.
    """

    code: str
    text: str
    hint: str
    field: str
    index: tuple[int, ...]

    def __init__(self, code: str, text: str, *, hint: str = "", field: str = "", index: Sequence[int] = ()) -> None:
        super().__init__(code, text)
        self.code, self.text, self.hint, self.field, self.index = code, text, hint, field, tuple(index)

    def __str__(self) -> str:
        where = f"element {', '.join(map(str, self.index))}: " if self.index else ""
        return f"{where}{self.text} [{self.code}]" + (f"\n  {self.hint}" if self.hint else "")


class ClampedWarning(UserWarning):
    """A temperature beyond 100 K to 100000 K counts as the nearer of the two, because clamp=True was asked for."""
