// Polynomials of one variable of low degree, and their roots in an interval.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace etendue {

// c[0] + c[1] x + ... + c[degree] x^degree.
struct Polynomial {
  static constexpr std::size_t max_degree = 9;
  std::array<double, max_degree + 1> c{};
  std::size_t degree = 0;

  static constexpr Polynomial constant(double a) { return {{a}, 0}; }
  static constexpr Polynomial linear(double a, double b) { return {{a, b}, 1}; }
  static constexpr Polynomial quadratic(double a, double b, double e) { return {{a, b, e}, 2}; }

  double operator()(double x) const {
    double sum = c[degree];
    for (std::size_t i = degree; i-- > 0;) sum = sum * x + c[i];
    return sum;
  }
  Polynomial derivative() const {
    Polynomial out;
    out.degree = degree > 0 ? degree - 1 : 0;
    for (std::size_t i = 1; i <= degree; ++i) out.c[i - 1] = static_cast<double>(i) * c[i];
    return out;
  }

  friend Polynomial operator+(Polynomial a, const Polynomial& b) {
    a.degree = std::max(a.degree, b.degree);
    for (std::size_t i = 0; i <= b.degree; ++i) a.c[i] += b.c[i];
    return a;
  }
  friend Polynomial operator-(Polynomial a, const Polynomial& b) {
    a.degree = std::max(a.degree, b.degree);
    for (std::size_t i = 0; i <= b.degree; ++i) a.c[i] -= b.c[i];
    return a;
  }
  friend Polynomial operator*(Polynomial a, double factor) {
    for (std::size_t i = 0; i <= a.degree; ++i) a.c[i] *= factor;
    return a;
  }
  // The degrees together are at most max_degree.
  friend Polynomial operator*(const Polynomial& a, const Polynomial& b) {
    Polynomial out;
    out.degree = a.degree + b.degree;
    for (std::size_t i = 0; i <= a.degree; ++i)
      for (std::size_t j = 0; j <= b.degree; ++j) out.c[i + j] += a.c[i] * b.c[j];
    return out;
  }
};

struct Roots {
  std::array<double, Polynomial::max_degree> at{};
  std::size_t count = 0;
  void add(double x) { at[count++] = x; }
  const double* begin() const { return at.data(); }
  const double* end() const { return at.data() + count; }
};

// How often the signs of p's Bernstein coefficients over [0, 1] change: as many roots as it has within, or more by an even number
// (Descartes' rule). b_i = sum_j C(i, j) / C(n, j) c_j, by Pascal's triangle.
inline int sign_variations(const Polynomial& p) {
  std::array<double, Polynomial::max_degree + 1> b = p.c;
  double choose = 1;
  for (std::size_t j = 0; j <= p.degree; ++j) {
    b[j] /= choose;
    choose *= static_cast<double>(p.degree - j) / static_cast<double>(j + 1);
  }
  for (std::size_t k = 1; k <= p.degree; ++k)
    for (std::size_t i = p.degree; i >= k; --i) b[i] += b[i - 1];
  int variations = 0;
  double last = 0;
  for (std::size_t i = 0; i <= p.degree; ++i) {
    if (b[i] == 0) continue;
    variations += last * b[i] < 0 ? 1 : 0;
    last = b[i] < 0 ? -1 : 1;
  }
  return variations;
}

// Where p changes its sign between a and b, once: Newton's steps, halvings where they leave the bracket.
inline double sign_change(const Polynomial& p, const Polynomial& slope, double a, double at_a, double b, double at_b) {
  double left = a, right = b, x = a + (b - a) * (at_a / (at_a - at_b));
  for (int step = 0; step < 80; ++step) {
    const double y = p(x);
    ((y < 0) == (at_a < 0) ? left : right) = x;
    double next = x - y / slope(x);
    if (!(next > left && next < right)) next = (left + right) / 2;
    if (std::abs(next - x) <= 1e-15 || next == left || next == right) break;
    x = next;
  }
  return x;
}

// Where p changes its sign within [0, 1], in order. Between two roots of its derivative p is monotone and has at most one. Roots without a
// change of sign are left out.
inline Roots sign_changes(const Polynomial& p) {
  Roots out;
  if (p.degree == 0) return out;
  const int variations = sign_variations(p);
  if (variations == 0) return out;
  const Polynomial slope = p.derivative();
  const Roots turns = variations == 1 ? Roots{} : sign_changes(slope);
  double a = 0, at_a = p(a);
  for (std::size_t i = 0; i <= turns.count; ++i) {
    const double b = i < turns.count ? turns.at[i] : 1, at_b = p(b);
    if ((at_a < 0) != (at_b < 0)) out.add(sign_change(p, slope, a, at_a, b, at_b));
    a = b, at_a = at_b;
  }
  return out;
}

}  // namespace etendue
