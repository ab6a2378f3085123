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

// Where p changes its sign between low and high, in order. Between two roots of its derivative p is monotone and has at most one root,
// which Newton's steps find, halvings where they leave the bracket. Roots without a change of sign are left out.
inline Roots sign_changes(const Polynomial& p, double low, double high) {
  Roots out;
  if (p.degree == 0) return out;
  const Polynomial slope = p.derivative();
  const Roots turns = sign_changes(slope, low, high);
  double a = low, at_a = p(a);
  for (std::size_t i = 0; i <= turns.count; ++i) {
    const double b = i < turns.count ? turns.at[i] : high, at_b = p(b);
    if ((at_a < 0) != (at_b < 0)) {
      double left = a, right = b, x = a + (b - a) * (at_a / (at_a - at_b));
      for (int step = 0; step < 80; ++step) {
        const double y = p(x);
        ((y < 0) == (at_a < 0) ? left : right) = x;
        double next = x - y / slope(x);
        if (!(next > left && next < right)) next = (left + right) / 2;
        if (std::abs(next - x) <= 1e-15 || next == left || next == right) break;
        x = next;
      }
      out.add(x);
    }
    a = b, at_a = at_b;
  }
  return out;
}

}  // namespace etendue
