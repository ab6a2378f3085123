"""Photometric files as Python sees them: the same numbers as the command's, arrays in and out, errors that say where."""

import math
import pathlib
import re

import numpy as np
import pytest

import etendue
from etendue import photometry

DATA = pathlib.Path(__file__).parents[1] / "cli" / "data"


def test_a_file_is_read_and_integrated() -> None:
    lamp = photometry.read(DATA / "panel.ldt")
    assert (lamp.format, lamp.type, lamp.symmetry, lamp.keyword("LUMINAIRE")) == ("eulumdat", "C", "about_0_180", "Panel")
    assert lamp.rated_lm == 3000 and lamp.watts == 25 and not lamp.absolute
    # Golden numbers of `etendue ies tests/cli/data/panel.ldt --json`.
    assert lamp.web().flux_lm == pytest.approx(3014.9901788488196, rel=1e-14)
    assert lamp.web("cos").flux_lm == pytest.approx(3032.429587223144, rel=1e-14)
    assert lamp.candelas.shape == (lamp.horizontal_deg.size, lamp.vertical_deg.size)
    assert lamp.candelas.max() == lamp.web().peak.cd == 1089
    assert lamp.web().luminance(0, 65) == pytest.approx(2921.94946390422, rel=1e-13)


def test_zones_add_up_and_shares_follow() -> None:
    web = photometry.read(DATA / "flood.ies").web()
    assert web.zones().sum() == pytest.approx(web.flux_lm, rel=1e-8)  # cones of type B are integrated to 1e-8
    output = web.output()
    assert output.downward_lm + output.upward_lm == pytest.approx(output.flux_lm, rel=1e-8)
    assert output.efficacy_lm_w == pytest.approx(web.flux_lm / 40)
    assert output.lor is None


def test_evaluation_broadcasts_and_agrees_with_directions() -> None:
    web = photometry.read(DATA / "panel.ldt").web()
    c, gamma = np.linspace(0, 350, 36)[:, None], np.linspace(1, 89, 23)
    cd = web.at(c, gamma)
    assert cd.shape == (36, 23)
    s, k = np.radians(gamma), np.radians(c)
    directions = np.stack(np.broadcast_arrays(np.sin(s) * np.cos(k), np.sin(s) * np.sin(k), -np.cos(s)), -1)
    assert np.allclose(web.towards(directions), cd, rtol=1e-11)
    assert float(web.at(20, 30)) == pytest.approx(float(web.at(380, 30)), rel=1e-12)


def test_samples_have_the_flux_without_variance() -> None:
    web = photometry.read(DATA / "panel.ldt").web()
    samples = web.sample(np.random.default_rng(3).random((1000, 2)))
    assert samples.direction.shape == (1000, 3)
    assert np.allclose(np.linalg.norm(samples.direction, axis=1), 1)
    lit = samples.pdf > 0
    assert np.allclose(samples.cd[lit] / samples.pdf[lit], web.flux_lm, rtol=1e-9)


def test_a_lambertian_grid_is_exact_in_the_cosine() -> None:
    gamma = np.linspace(0, 90, 10)
    lamp = photometry.Photometry.of_grid(gamma, [0.0], 300 * np.cos(np.radians(gamma))[None, :].clip(0))
    assert lamp.symmetry == "rotational"
    assert lamp.web("cos").flux_lm == pytest.approx(300 * math.pi, rel=1e-12)


def test_conversions_keep_the_light_and_say_what_they_lose(tmp_path: pathlib.Path) -> None:
    lamp = photometry.read(DATA / "panel.ldt")
    losses = lamp.write(tmp_path / "panel.ies")
    assert losses and all(loss.what and loss.effect for loss in losses)
    back = photometry.read(tmp_path / "panel.ies")
    assert back.format == "ies" and back.version == "2002"
    assert back.web().flux_lm == pytest.approx(lamp.web().flux_lm, rel=1e-12)
    data, _ = lamp.to_bytes()
    assert photometry.parse(data).candelas.tolist() == lamp.candelas.tolist()


def test_transforms_state_their_error() -> None:
    lamp = photometry.read(DATA / "panel.ldt")
    coarse, error_cd = lamp.resampled(40, 90)
    difference = lamp.web().difference(coarse.web())
    assert difference.exact
    assert abs(difference.largest_cd) == pytest.approx(error_cd, rel=1e-12)
    assert error_cd > 1
    turned = lamp.turned(30)
    assert float(turned.web().at(50, 40)) == pytest.approx(float(lamp.web().at(20, 40)), rel=1e-12)
    assert lamp.scaled(1234).web().flux_lm == pytest.approx(1234, rel=1e-12)
    folded, folding_cd = lamp.folded(0.5)
    assert folded.symmetry == "rotational" and folding_cd > 0


def test_beam_angles_and_nema() -> None:
    web = photometry.read(DATA / "flood.ies").web()
    vertical, horizontal = web.beam(0, 0.1), web.beam(90, 0.1)
    assert vertical is not None and horizontal is not None
    assert (photometry.nema_type(horizontal.full_deg), photometry.nema_type(vertical.full_deg)) == (7, 5)
    assert photometry.nema_type(5) is None


def test_errors_say_what_and_where() -> None:
    with pytest.raises(etendue.Error) as broken:
        photometry.read(DATA / "broken.ies")
    assert re.search(r"broken\.ies:\d+:\d+: ", str(broken.value))
    with pytest.raises(etendue.Error, match="FORMAT_UNKNOWN"):
        photometry.parse(b"no such file")
    with pytest.raises(etendue.Error, match="SHAPE_MISMATCH"):
        photometry.Photometry.of_grid([0, 90], [0], [[1, 2, 3]])
    with pytest.raises(etendue.Error, match="WEB_INVALID"):
        photometry.Photometry.of_grid([0, 90], [0], [[1, math.nan]])
    with pytest.raises(etendue.Error, match="WEB_INVALID"):
        photometry.read(DATA / "flood.ies").turned(90)
    with pytest.raises(etendue.Error, match="SHAPE_MISMATCH"):
        photometry.read(DATA / "panel.ldt").web().towards([1.0, 2.0])
    with pytest.raises(etendue.Error, match="FORMAT_UNKNOWN"):
        photometry.read(DATA / "panel.ldt").write("lamp.txt")
