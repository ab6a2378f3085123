"""Normal maps turn into roughness."""

import math

import numpy as np
import pytest

from etendue import Error, normal_filter


def test_concentration_and_length_are_each_others_way_back() -> None:
    kappa = np.geomspace(0.1, 1e4, 40)
    lengths = normal_filter.mean_length(kappa)
    assert lengths == pytest.approx(1 / np.tanh(kappa) - 1 / kappa, abs=1e-12)
    # 1e-12 / (1 - length) relative, and 1 - length is about 1 / kappa.
    assert normal_filter.concentration(lengths) == pytest.approx(kappa, rel=1e-7)
    assert normal_filter.concentration(1.0) == math.inf


def test_methods() -> None:
    length = normal_filter.mean_length(200.0)
    # alpha^2 + 2 / kappa; as printed it is far less.
    assert normal_filter.filtered(0.05, length, "slopes").alpha == pytest.approx(math.sqrt(0.0025 + 0.01), rel=1e-9)
    assert normal_filter.filtered(0.05, length, "listing32").alpha < 0.09
    nearest = normal_filter.filtered(0.05, length)
    assert 0.05 < nearest.alpha < 0.15 and 0 < nearest.misplaced < 0.2
    alphas, _ = normal_filter.filtered_many([0.05, 0.3, 1.0], [[1.0], [0.99]])
    assert alphas.shape == (2, 3)
    assert alphas[0] == pytest.approx([0.05, 0.3, 1.0], abs=1e-6)
    assert np.all(alphas[1, :2] > alphas[0, :2])  # the nearest to an alpha of 1 is hardly wider, or narrower


def test_levels_keep_their_mean() -> None:
    random = np.random.default_rng(5)
    normals = random.normal(size=(5, 7, 3)) * [0.3, 0.3, 0] + [0, 0, 1]
    unit = normals / np.linalg.norm(normals, axis=-1, keepdims=True)
    levels = normal_filter.levels(normals, 0.2)
    assert [level.means.shape for level in levels] == [(5, 7, 3), (2, 3, 3), (1, 1, 3)]
    # Float32 sums of 35 vectors.
    assert levels[-1].means[0, 0] == pytest.approx(unit.mean(axis=(0, 1)), abs=1e-5)
    assert levels[0].alphas == pytest.approx(np.full((5, 7), 0.2), abs=1e-6)
    assert levels[-1].alphas[0, 0] > 0.2
    assert levels[-1].authored_alphas[0, 0] == pytest.approx(0.2, abs=1e-6)
    each = normal_filter.levels(normals, np.full((5, 7), 0.2))
    assert np.array_equal(each[1].alphas, levels[1].alphas)


def test_what_is_wrong_is_said() -> None:
    for wrong, code in (
        (lambda: normal_filter.levels(np.ones((4, 4)), 0.2), "SHAPE_MISMATCH"),
        (lambda: normal_filter.levels(np.ones((4, 4, 3)), np.ones(4)), "SHAPE_MISMATCH"),
        (lambda: normal_filter.levels(np.zeros((4, 4, 3)), 0.2), "FIELD_UNSUITABLE"),
        (lambda: normal_filter.levels(np.ones((4, 4, 3)), 2.0), "FIELD_UNSUITABLE"),
        (lambda: normal_filter.filtered(0.1, 0.9, "beckmann"), "METHOD_UNKNOWN"),  # type: ignore[arg-type]
        (lambda: normal_filter.filtered_many(np.ones(2), np.ones(3)), "SHAPE_MISMATCH"),
    ):
        with pytest.raises(Error) as caught:
            wrong()
        assert caught.value.code == code
