"""Photometric files: IES LM-63 and EULUMDAT read, checked, evaluated, integrated, sampled, converted and written.

>>> import numpy as np
>>> gamma = np.linspace(0, 180, 37)
>>> lamp = Photometry.of_grid(gamma, [0.0], np.full((1, 37), 100.0))
>>> web = lamp.web()
>>> round(web.flux_lm, 9) == round(400 * np.pi, 9)
True
>>> web.at(0, [0, 45, 90])
array([100., 100., 100.])
"""

import dataclasses
import itertools
import os
import pathlib
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .errors import Error

Interpolation = Literal["linear", "cos", "cubic"]
Format = Literal["ies", "eulumdat"]
Floats = NDArray[np.float64]


class Message(NamedTuple):
    """What was repaired or looks wrong. severity: "note", "warning" or "error"; line and column count from 1, 0 where there is none."""

    severity: str
    code: str
    text: str
    line: int
    column: int
    hint: str


class Loss(NamedTuple):
    """What another format or grid could not keep, and what became of it."""

    what: str
    effect: str


class Spread(NamedTuple):
    """A full angle in degrees, its ends as signed gammas, and whether it is only as wide as the table."""

    full_deg: float
    towards_c_deg: float
    away_deg: float
    ends_with_table: bool


class Output(NamedTuple):
    """Where the light goes: lumens, shares of them, and of the lamps' stated flux (None where the file states none)."""

    flux_lm: float
    downward_lm: float
    upward_lm: float
    downward_share: float
    lor: float | None
    dlor: float | None
    ulor: float | None
    efficacy_lm_w: float | None


class Peak(NamedTuple):
    """The brightest node of the table, in cd, at the web's own angles in degrees."""

    cd: float
    vertical_deg: float
    horizontal_deg: float


class Opening(NamedTuple):
    """The luminous opening: a shape's name, and metres across, along and up."""

    shape: str
    width_m: float
    length_m: float
    height_m: float


class Samples(NamedTuple):
    """Unit vectors (..., 3), their density in 1/sr and their intensity in cd."""

    direction: Floats
    pdf: Floats
    cd: Floats


class Difference(NamedTuple):
    """The second web's intensity less the first's: the largest and where, and over all directions, in cd; and their flux in lm."""

    largest_cd: float
    c_deg: float
    gamma_deg: float
    exact: bool
    mean_cd: float
    mean_abs_cd: float
    rms_cd: float
    flux_lm: float


@dataclasses.dataclass(frozen=True)
class Web:
    """An intensity distribution made ready. The nadir is -z, C0 is +x, C90 is +y; beyond the table it is dark."""

    _web: _core.PhotometricWeb

    @property
    def flux_lm(self) -> float:
        """The exact integral of what is evaluated, lm."""
        return self._web.flux_lm()

    @property
    def peak(self) -> Peak:
        """The brightest node."""
        return Peak(*self._web.peak())

    def at(self, c_deg: ArrayLike, gamma_deg: ArrayLike) -> Floats:
        """Luminous intensity in cd towards C and gamma in degrees, which broadcast; gamma from the nadir."""
        c, gamma = np.broadcast_arrays(np.asarray(c_deg, np.float64), np.asarray(gamma_deg, np.float64))
        return np.asarray(self._web.at(np.ascontiguousarray(np.stack([c, gamma], -1))))

    def towards(self, directions: ArrayLike) -> Floats:
        """Luminous intensity in cd towards vectors (..., 3) of any length but 0."""
        return np.asarray(self._web.towards(_rows(directions, 3, "directions")))

    def flux_between(self, from_gamma_deg: float, to_gamma_deg: float) -> float:
        """Lumens between two cones about the nadir."""
        return self._web.flux_between(from_gamma_deg, to_gamma_deg)

    def zones(self, step_deg: float = 10.0) -> Floats:
        """Lumens of cones about the nadir, from 0 to 180 degrees in equal steps."""
        edges = np.linspace(0.0, 180.0, round(180.0 / step_deg) + 1)
        return np.array([self.flux_between(float(a), float(b)) for a, b in itertools.pairwise(edges)])

    def cie_cone_flux_lm(self) -> tuple[float, float, float, float]:
        """Lumens within a quarter, a half, three quarters and all of the lower hemisphere: 41.41, 60, 75.52 and 90 degrees."""
        return self._web.cie_cone_flux_lm()

    def output(self) -> Output:
        """Lumens downwards and upwards, light output ratios and efficacy."""
        return Output(*self._web.output())

    def beam(self, plane: Literal[0, 90] = 0, share: float = 0.5, about: Literal["peak", "axis"] = "peak") -> Spread | None:
        """Where the intensity of the plane C-(C + 180) falls to a share of its peak (IES) or of that at gamma 0 (CIE). None in the dark."""
        found = (self._web.spread_about_peak if about == "peak" else self._web.spread_about_axis)(plane, share)
        return None if found is None else Spread(*found)

    def luminance(self, c_deg: float, gamma_deg: float) -> float | None:
        """Mean luminance of the opening towards a direction, cd/m2; None where none of it is seen, or its size is not known."""
        return self._web.luminance(c_deg, gamma_deg)

    def sample(self, u: ArrayLike) -> Samples:
        """Directions for numbers (..., 2) in [0, 1), in proportion to the intensity: exactly cd / flux_lm is their density."""
        found = np.asarray(self._web.sample(_rows(u, 2, "u")))
        return Samples(found[..., :3], found[..., 3], found[..., 4])

    def difference(self, other: "Web") -> Difference:
        """The other's intensity less this one's."""
        return Difference(*self._web.difference(other._web))


@dataclasses.dataclass(frozen=True)
class Photometry:
    """A photometric file: its grid, values and factors as written."""

    _distribution: _core.PhotometricDistribution

    @classmethod
    def of_grid(
        cls, vertical_deg: ArrayLike, horizontal_deg: ArrayLike, candelas: ArrayLike, type: Literal["A", "B", "C"] = "C"
    ) -> "Photometry":
        """Of candelas[horizontal, vertical], with LM-63's angles in degrees; one plane of type C is rotational. Error: WEB_INVALID."""
        v, h = (np.ascontiguousarray(np.asarray(x, np.float64)) for x in (vertical_deg, horizontal_deg))
        cd = np.ascontiguousarray(np.asarray(candelas, np.float64))
        if v.ndim != 1 or h.ndim != 1 or cd.shape != (h.size, v.size):
            raise Error("SHAPE_MISMATCH", f"expected candelas of shape ({h.size}, {v.size}), found {cd.shape}", field="candelas")
        return cls(_core.PhotometricDistribution.of_grid(type, v, h, cd))

    @property
    def format(self) -> Format:
        """The kind of file: ies or eulumdat."""
        return self._distribution.format()  # type: ignore[return-value]

    @property
    def version(self) -> str:
        """LM-63's year; "" of EULUMDAT."""
        return self._distribution.version()

    @property
    def type(self) -> str:
        """LM-63's photometric type: A, B or C."""
        return self._distribution.type()

    @property
    def symmetry(self) -> str:
        """Which part of the web is stored."""
        return self._distribution.symmetry()

    @property
    def vertical_deg(self) -> Floats:
        """Angles of the grid."""
        return np.asarray(self._distribution.vertical_deg())

    @property
    def horizontal_deg(self) -> Floats:
        """Angles of the grid."""
        return np.asarray(self._distribution.horizontal_deg())

    @property
    def candelas(self) -> Floats:
        """Candelas of the grid, [horizontal, vertical], factors included."""
        return np.asarray(self._distribution.candelas())

    @property
    def rated_lm(self) -> float | None:
        """Flux that the file states for its lamps; None in IES's absolute photometry."""
        return self._distribution.rated_lm()

    @property
    def watts(self) -> float:
        """Input power, W; 0 where it is not stated."""
        return self._distribution.watts()

    @property
    def absolute(self) -> bool:
        """Whether candelas do not scale with the lamp."""
        return self._distribution.absolute()

    @property
    def opening(self) -> Opening:
        """The luminous opening."""
        return Opening(*self._distribution.opening())

    @property
    def messages(self) -> list[Message]:
        """Repairs and doubts of the reading."""
        return [Message(*m) for m in self._distribution.messages()]

    def review(self) -> list[Message]:
        """What is well-formed but hardly meant: efficiency, closure of the planes, stated shares of the flux."""
        return [Message(*m) for m in self._distribution.review()]

    def keyword(self, name: str) -> str:
        """Text of an IES keyword; of EULUMDAT LUMINAIRE, MANUFAC, LUMCAT, TEST, LAMP; "" if there is none."""
        return self._distribution.keyword(name)

    def web(self, interpolation: Interpolation = "linear", *, clockwise: bool = False, turn_deg: float = 0.0) -> Web:
        """Made ready to be evaluated: linear in the angle, in its cosine ("cos"), or monotone cubic."""
        return Web(self._distribution.web(interpolation, clockwise, turn_deg))

    def scaled(self, flux_lm: float) -> "Photometry":
        """Scaled to emit this flux. Error: WEB_INVALID in the dark."""
        return Photometry(self._distribution.scaled(flux_lm))

    def turned(self, turn_deg: float) -> "Photometry":
        """With this added to every C angle; no intensity changes. Error: WEB_INVALID of types A and B."""
        return Photometry(self._distribution.turned(turn_deg))

    def folded(self, tolerance: float = 0.0) -> tuple["Photometry", float]:
        """The part whose mirrors give the rest within a share of the peak, and the largest deviation in cd."""
        folded, error_cd = self._distribution.folded(tolerance)
        return Photometry(folded), error_cd

    def resampled(self, vertical_step_deg: float, horizontal_step_deg: float | None = None) -> tuple["Photometry", float]:
        """On equal steps of at most these degrees, and the exact largest difference of the two webs in cd."""
        found, error_cd = self._distribution.resampled(vertical_step_deg, horizontal_step_deg or vertical_step_deg)
        return Photometry(found), error_cd

    def to_bytes(self, format: Format | None = None, *, year: int = 2002, turn: bool = True) -> tuple[bytes, list[Loss]]:
        """As a file's bytes, and what they could not keep. turn: across formats, from one convention of C0 to the other.

        Errors: EXPORT_UNSUPPORTED, WEB_INVALID.
        """
        data, losses = self._distribution.written(format or self.format, str(year), turn)
        return data, [Loss(*loss) for loss in losses]

    def write(self, path: str | os.PathLike[str], *, year: int = 2002, turn: bool = True) -> list[Loss]:
        """To .ies or .ldt, by the name's end; what is there is replaced."""
        target = pathlib.Path(path)
        formats: dict[str, Format] = {".ies": "ies", ".ldt": "eulumdat"}
        if target.suffix.lower() not in formats:
            raise Error("FORMAT_UNKNOWN", f"expected a name that ends in .ies or .ldt, found {target.name}", field="path")
        data, losses = self.to_bytes(formats[target.suffix.lower()], year=year, turn=turn)
        target.write_bytes(data)
        return losses


def parse(data: bytes, name: str = "", *, strict: bool = False, lamp_set: int = 1, format: Format | None = None) -> Photometry:
    """A file's bytes, told apart by their content. Tolerant unless strict: each repair is one of `messages`. lamp_set: EULUMDAT's, from 1.

    Errors say the line and the column in their text.
    """
    if lamp_set < 1:
        raise Error("LAMP_SET_MISSING", f"expected a lamp set from 1 on, found {lamp_set}", field="lamp_set")
    mode = "strict" if strict else "tolerant"
    return Photometry(_core.PhotometricDistribution.read(data, name, format or "", mode, lamp_set - 1))


def read(path: str | os.PathLike[str], *, strict: bool = False, lamp_set: int = 1) -> Photometry:
    """A .ies or .ldt file; as parse()."""
    source = pathlib.Path(path)
    return parse(source.read_bytes(), str(source), strict=strict, lamp_set=lamp_set)


def nema_type(field_deg: float) -> int | None:
    """NEMA's beam type of a floodlight by its field angle: 1 from 10 degrees to 7 beyond 130; None below 10."""
    return _core.nema_type(field_deg)


def _rows(values: ArrayLike, width: int, name: str) -> Floats:
    rows = np.ascontiguousarray(np.asarray(values, np.float64))
    if rows.ndim == 0 or rows.shape[-1] != width:
        raise Error("SHAPE_MISMATCH", f"expected {name} of {width} numbers in the last extent, found shape {rows.shape}", field=name)
    return rows
