// Hypotheses about what makes two pictures differ: each predicts the reference from ours.
#pragma once

#include "evidence.h"

#include <functional>
#include <string>
#include <vector>

namespace etendue::compare_detail {

// `predict` fills `picture` with the reference as it would be, and `slopes` with its derivative by each parameter. All parameters 0: ours
// as it is.
struct Model {
  enum class Kind { scale, gamma, shift, filter, light_scale, light_shape };
  Kind kind = Kind::scale;
  std::string light;  // of the light_... kinds
  int parameters = 1;
  bool linear = true;
  bool light_absent = false;  // our own layer of the light is black or not there
  std::function<void(const std::vector<double>& theta, std::vector<double>& picture, std::vector<std::vector<double>>& slopes)> predict;
};

// The models for a picture `base` (ours, or ours after earlier findings), with the light layers of both pictures.
std::vector<Model> models_for(const std::vector<double>& base, const Evidence& evidence, const Picture& ours, const Picture& reference);

// The light of a picture that holds it alone, thrown elsewhere.
Model own_shape_model(const std::vector<double>& base, const Evidence& evidence, const std::string& light);

struct Fit {
  std::vector<double> theta;
  std::vector<double> errors;  // standard errors of theta
  double chi2 = 0;             // of what is left
  double chi2_before = 0;
  std::vector<double> predicted;
};

// Weights of the pixels, 1/sigma^2 with a sigma that does not follow the pixel's own noise; 0 on the emitters.
std::vector<double> weights_of(const Evidence& evidence);

// Weighted least squares, by Gauss-Newton where the model is not linear.
Fit fit(const Model& model, const Evidence& evidence, const std::vector<double>& weights);

}  // namespace etendue::compare_detail
