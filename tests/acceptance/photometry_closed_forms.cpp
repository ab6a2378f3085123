// Webs whose flux is known: each interpolant against quadrature of itself, closed forms, convergence, directions to angles and back. Prints
// a line of JSON for each figure with its limit: for the script `photometry`.
#include <cmath>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>
#include <random>

#include "photometry/gauss.h"
#include "photometry_builder.h"

namespace {

using namespace etendue;
using test::distribution_of;
using test::steps;

constexpr Interpolation all[] = {Interpolation::linear, Interpolation::cosine, Interpolation::cubic};
constexpr const char* names[] = {"linear", "cosine", "cubic"};
const char* name_of(Interpolation i) { return names[static_cast<int>(i)]; }

void print(const std::string& name, double value, double limit) {
  std::cout << nlohmann::json{{"name", name}, {"value", value}, {"limit", limit}}.dump() << '\n';
}

// Cell by cell: Gauss's rule along the polar angle, and the middle along the azimuth, in which every interpolant is linear.
double flux_by_quadrature(const IntensityWeb& web) {
  const std::vector<double>& polar = web.polar().nodes();
  std::vector<double> azimuth = web.azimuth().nodes();
  if (azimuth.size() < 2) azimuth = {0, 360};
  double sum = 0;
  for (std::size_t j = 0; j + 1 < azimuth.size(); ++j) {
    for (std::size_t i = 0; i + 1 < polar.size(); ++i) {
      const double middle = 0.5 * (polar[i] + polar[i + 1]), half = 0.5 * (polar[i + 1] - polar[i]);
      double cell = 0;
      for (const photometry::GaussNode& node : photometry::gauss_16) {
        const double theta = middle + half * node.x;
        cell += node.weight * web.at_own_angles(web.unfolded(theta, 0.5 * (azimuth[j] + azimuth[j + 1]), 0)) * std::sin(theta * pi / 180);
      }
      sum += cell * half * (azimuth[j + 1] - azimuth[j]) * (pi / 180) * (pi / 180);
    }
  }
  return web.copies() * sum;
}

double bumpy(const Vec3d& u) { return std::max(0.0, 60 + 60 * u.x + 35 * std::sin(5 * u.y) - 30 * u.z + 20 * std::cos(9 * u.x * u.z)); }

void interpolants_against_quadrature() {
  const std::vector<double> gamma{0, 3, 10, 11, 40, 77.5, 90, 120, 180}, half{0, 7, 30, 90}, whole{-90, -22, 0, 5, 90};
  double worst[3][3] = {};
  for (const auto& d : {distribution_of(WebType::c, WebSymmetry::none, gamma, {0, 110, 200, 310}, bumpy),
                        distribution_of(WebType::c, WebSymmetry::rotational, gamma, {0}, bumpy),
                        distribution_of(WebType::c, WebSymmetry::quadrant, gamma, {0, 20, 35, 90}, bumpy),
                        distribution_of(WebType::c, WebSymmetry::about_90_270, steps(0, 180, 2.5), {-90, -80, 30, 90}, bumpy),
                        distribution_of(WebType::b, WebSymmetry::none, whole, whole, bumpy),
                        distribution_of(WebType::b, WebSymmetry::lateral, whole, half, bumpy),
                        distribution_of(WebType::a, WebSymmetry::vertical, half, whole, bumpy),
                        distribution_of(WebType::a, WebSymmetry::lateral_and_vertical, half, half, bumpy)}) {
    for (const Interpolation interpolation : all) {
      const IntensityWeb web = test::web_of(d, interpolation);
      double& w = worst[static_cast<int>(d.grid.type)][static_cast<int>(interpolation)];
      w = std::max(w, std::abs(flux_by_quadrature(web) / web.flux_lm() - 1));
    }
  }
  for (const WebType type : {WebType::c, WebType::a, WebType::b})
    for (const Interpolation i : all)
      print("flux of type " + std::string(name_of(type)) + ", " + name_of(i) + ", against quadrature of what is evaluated, relative",
            worst[static_cast<int>(type)][static_cast<int>(i)], 1e-12);
}

// Of all directions, in steps of so many degrees.
IntensityDistribution around(WebType type, double step, const std::function<double(const Vec3d&)>& form) {
  const std::vector<double> meridian = steps(-90, 90, step), circle = steps(-180, 180, step);
  switch (type) {
    case WebType::a:
      return distribution_of(type, WebSymmetry::none, meridian, circle, form);
    case WebType::b:
      return distribution_of(type, WebSymmetry::none, circle, meridian, form);
    default:
      return distribution_of(type, WebSymmetry::none, steps(0, 180, step), steps(0, 360, step), form);
  }
}

void closed_forms() {
  for (const WebType type : {WebType::c, WebType::a, WebType::b}) {
    const std::string of_type = "type " + std::string(name_of(type));
    double worst = 0;
    for (const double step : {1.0, 5.0, 15.0, 45.0})
      for (const Interpolation i : all)
        worst = std::max(worst, std::abs(test::web_of(around(type, step, [](const Vec3d&) { return 7; }), i).flux_lm() / (28 * pi) - 1));
    print(of_type + ": isotropic light, any step, all interpolants, flux, relative", worst, 1e-14);
    const auto flood_off = [&](double step) {
      return std::abs(test::web_of(around(type, step, test::floodlight)).flux_lm() / test::floodlight_flux_lm - 1);
    };
    const double coarse = flood_off(0.5), fine = flood_off(0.25);
    print(of_type + ": floodlight in steps of .25 deg, flux, relative", fine, 1e-4);
    print(of_type + ": its order of convergence, less 2", std::abs(std::log2(coarse / fine) - 2), 0.05);
  }
  const auto lambertian = [](const Vec3d& u) { return std::max(0.0, -u.z); };
  const auto lambertian_off = [&](double step, Interpolation i) {
    return std::abs(
        test::web_of(distribution_of(WebType::c, WebSymmetry::rotational, steps(0, 90, step), {0}, lambertian), i).flux_lm() / pi - 1);
  };
  double worst = 0;
  for (const double step : {1.0, 5.0, 15.0, 45.0}) worst = std::max(worst, lambertian_off(step, Interpolation::cosine));
  print("Lambertian, cosine, any step, flux, relative", worst, 1e-14);
  print("Lambertian, linear: its order of convergence, less 2",
        std::abs(std::log2(lambertian_off(1, Interpolation::linear) / lambertian_off(0.5, Interpolation::linear)) - 2), 0.05);
}

void directions_and_angles() {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::vector<Vec3d> directions{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const std::vector<Vec3d> poles = directions;
  for (const Vec3d& pole : poles)
    for (const double near : {1e-3, 1e-8, 1e-15, 1e-200})
      directions.push_back(normalised(pole + near * Vec3d{normal(random), normal(random), normal(random)}));
  while (directions.size() < 1'000'000) directions.push_back(normalised(Vec3d{normal(random), normal(random), normal(random)}));
  for (const WebType type : {WebType::c, WebType::a, WebType::b}) {
    double worst = 0;
    for (const Vec3d& u : directions) worst = std::max(worst, length(direction_of(type, angles_of(type, u)) - u));
    print("type " + std::string(name_of(type)) + ": direction to angles and back, a million and the poles", worst, 1e-14);
  }
}

}  // namespace

int main() {
  interpolants_against_quadrature();
  closed_forms();
  directions_and_angles();
}
