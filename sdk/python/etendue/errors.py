"""The one exception of this package."""

from collections.abc import Sequence

# What messages call the parameters, where the library did not say which one it is about.
_CALLED = {
    "T-stop": "t_stop",
    "f-number": "f_number",
    "frame rate": "frames_per_s",
    "shutter angle": "shutter_angle_rad",
    "shutter time": "shutter_s",
    "(ISO)": "iso",
    "density": "nd_density",
    "compensation": "compensation_stop",
    "efficacy": "efficacy",
    "needs the distance": "distance",
    "expected a distance": "distance",
    "radius": "radius",
    "width": "width",
    "height": "height",
    "length": "length",
    "area": "area_m2",
    "inner half angle": "inner",
    "outer half angle": "outer",
    "opening angle": "outer",
    "angular_diameter": "angular_diameter",
    "meter constant K": "meter_k",
    "meter constant C": "meter_c",
    "light's shape": "shape",
    "a temperature": "kelvin",
    "no surface": "shape",
    "says nothing about": "shape",
}


def _parameter(text: str) -> str:
    places = {text.find(name): field for name, field in _CALLED.items() if name in text}
    return places[min(places)] if places else ""


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
        self.code, self.text, self.hint, self.index = code, text, hint, tuple(index)
        self.field = field or _parameter(text)

    def __str__(self) -> str:
        where = f"element {', '.join(map(str, self.index))}: " if self.index else ""
        return f"{where}{self.text} [{self.code}]" + (f"\n  {self.hint}" if self.hint else "")
